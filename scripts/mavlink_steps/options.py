"""What the program is told on its command line."""
import argparse
import math
import uuid

from camera import FLATTEST, lean
from gimbal import STATUS

FLATTEST_DEG = math.degrees(FLATTEST)


def parse_address(text):
    host, _, port = text.rpartition(":")
    if not port.isdigit():
        raise argparse.ArgumentTypeError(f"'{text}': write PORT or HOST:PORT")
    return host.strip("[]") or "0.0.0.0", int(port)


def parse_number(text):
    number = float(text)
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"'{text}': write a number")
    return number


def parse_delay(text):
    delay_s = parse_number(text)
    if delay_s < 0.0:
        raise argparse.ArgumentTypeError(f"'{text}': no picture is written before it was taken")
    return delay_s


def parse_lean(text):
    angle_deg = parse_number(text)
    if abs(angle_deg) > FLATTEST_DEG:
        raise argparse.ArgumentTypeError(f"'{text}': at most {FLATTEST_DEG:g} degrees from straight down, which is 0: "
                                         "the -90 of a gimbal is a pitch of 0")
    return angle_deg


def parse_interval(text):
    interval_s = parse_number(text)
    if interval_s <= 0.0:
        raise argparse.ArgumentTypeError(f"'{text}': write more than 0")
    return interval_s


def _add_vehicle(parser):
    parser.add_argument("--listen", type=parse_address, default=("0.0.0.0", 14551), metavar="[HOST:]PORT",
                        help="where MAVLink comes in by UDP (default: 14551)")
    parser.add_argument("--system", type=int, choices=range(1, 256), metavar="ID",
                        help="the vehicle's system id (default: that of the first message)")
    parser.add_argument("--component", type=int, default=1,
                        help="the autopilot's component id; others of the system are ignored (default: %(default)d)")
    parser.add_argument("--by-air", action="store_true", help="movements by airspeed and heading")


def _add_camera(parser):
    parser.add_argument("--camera", choices=("body", "level", "gimbal"), required=True,
                        help="body: fixed to the airframe, looking down; level: held straight down by a gimbal that "
                             "follows the nose; gimbal: as the gimbal tells (" + STATUS + ")")
    parser.add_argument("--gimbal", type=int, metavar="ID",
                        help="of --camera gimbal: the gimbal's id, which is that of its component, or 1 to 6 where the "
                             "autopilot answers for it (default: that of the first message)")
    parser.add_argument("--camera-yaw", type=parse_number, default=0.0, metavar="DEGREES",
                        help="where the picture's upper edge points, clockwise from the nose, or from where "
                             "a gimbal says that it points (default: 0)")
    parser.add_argument("--camera-pitch", type=parse_lean, default=0.0, metavar="DEGREES",
                        help="how far the camera is tilted towards that edge from where it would look, straight down "
                             "through the floor, straight down, or where a gimbal says (default: 0)")
    parser.add_argument("--camera-roll", type=parse_lean, default=0.0, metavar="DEGREES",
                        help="the same, of its right side down: it looks farther to the left (default: 0)")


def _add_heights(parser):
    ground = parser.add_mutually_exclusive_group()
    ground.add_argument("--agl", type=parse_number, metavar="M",
                        help="height above ground, instead of what the autopilot tells")
    ground.add_argument("--by-terrain", action="store_true",
                        help="the map knows how high its ground is (roadfix terrain): tell the height above the sea "
                             "alone")
    parser.add_argument("--takeoff-agl", type=parse_number, default=0.0, metavar="M",
                        help="how much higher than the ground in the pictures the take-off lay (default: 0)")


def _add_pictures(parser):
    parser.add_argument("--watch", required=True, metavar="FOLDER", help="folder into which the camera writes")
    parser.add_argument("--delay", type=parse_delay, default=0.0, metavar="S",
                        help="from the capture of a picture to its file (default: 0)")
    parser.add_argument("--every", type=parse_interval, metavar="S",
                        help="seconds between pictures, by which their names are numbered, as of ffmpeg with fps=1/S: "
                             "those that come later and later are left out (default: by their EXIF, where they have "
                             "some)")


def _check_lean(parser, options):
    lean_deg = math.degrees(lean(math.radians(options.camera_roll), math.radians(options.camera_pitch)))
    if lean_deg > FLATTEST_DEG:
        parser.error(f"--camera-pitch {options.camera_pitch:g} and --camera-roll {options.camera_roll:g} are together "
                     f"{lean_deg:.1f} degrees from straight down: at most {FLATTEST_DEG:g}")


def parse_arguments(description, arguments):
    parser = argparse.ArgumentParser(prog="mavlink_steps", description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for add in (_add_vehicle, _add_pictures, _add_camera, _add_heights):
        add(parser)
    parser.set_defaults(origin=uuid.uuid4().hex)  # sums of velocities begin anew with each start
    options = parser.parse_args(arguments)
    _check_lean(parser, options)
    return options
