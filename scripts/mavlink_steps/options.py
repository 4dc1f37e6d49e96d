"""What the program is told on its command line."""
import argparse
import math
import pathlib
import uuid

from camera import FLATTEST, lean
from gimbal import STATUS
from table import fits_a_cell

FLATTEST_DEG = math.degrees(FLATTEST)
#: What a table tells of a camera: of how many numbers, None of any
CAMERA = {"fov_deg": 1, "focal_px": 1, "principal_px": 2, "distortion": None, "lens": None, "attitude_sigma_deg": 1}
LENSES = ("perspective", "fisheye")
LARGEST_PORT = 65535


def parse_address(text):
    host, _, port = text.rpartition(":")
    if not port.isdigit() or int(port) > LARGEST_PORT:
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


def parse_table(text):
    if not fits_a_cell(pathlib.Path(text).stem):
        raise argparse.ArgumentTypeError(f"'{text}': its name is that of the flight, in a table that can hold no "
                                         "commas, quotes, line breaks or outer blanks")
    return text


def parse_camera(text):
    """NAME=VALUE as scripts/ground_station takes it of pictures, as column and cell of a table."""
    name, _, value = text.partition("=")
    if name not in CAMERA:
        raise argparse.ArgumentTypeError(f"'{text}': write NAME=VALUE, the name one of {', '.join(CAMERA)}")
    if name == "lens":
        if value not in LENSES:
            raise argparse.ArgumentTypeError(f"'{text}': write {' or '.join(LENSES)}")
        return name, value
    try:
        numbers = [parse_number(part) for part in value.strip("[]").split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}': write a number, or several with commas between") from None
    if CAMERA[name] not in (None, len(numbers)):
        raise argparse.ArgumentTypeError(f"'{text}': it has {len(numbers)} numbers, not {CAMERA[name]}")
    return name, " ".join(f"{number:.15g}" for number in numbers)


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
                        help="how far the camera is tilted towards that edge, against straight down through the "
                             "airframe's floor (body), straight down (level), or where the gimbal says that it looks "
                             "(default: 0)")
    parser.add_argument("--camera-roll", type=parse_lean, default=0.0, metavar="DEGREES",
                        help="how far its right side is turned down against the same, so that it looks farther to the "
                             "left (default: 0)")


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


def _add_recording(parser):
    parser.add_argument("--csv", type=parse_table, metavar="FILE",
                        help="record here the flight of a vehicle that has GPS (GLOBAL_POSITION_INT, GPS_RAW_INT), a "
                             "new table of its pictures for roadfix boresight, bench and fly --over")
    parser.add_argument("--frame", nargs="+", type=parse_camera, default=[], metavar="NAME=VALUE",
                        help="of --csv: what the table tells of the camera, fov_deg, or focal_px and principal_px, "
                             "distortion, lens; and attitude_sigma_deg")


def _check_recording(parser, options):
    options.frame = dict(options.frame)
    if options.csv is None and options.frame:
        parser.error("--frame is what --csv tells of the camera, and there is no --csv")
    lens = set(options.frame) - {"attitude_sigma_deg"}
    has_lens = "fov_deg" not in lens if "focal_px" in lens else lens == {"fov_deg"}
    if options.csv is not None and not has_lens:
        parser.error("--csv needs --frame fov_deg=DEGREES, or --frame focal_px=PIXELS and what else a calibration "
                     "tells (principal_px, distortion, lens)")


def _check_lean(parser, options):
    lean_deg = math.degrees(lean(math.radians(options.camera_roll), math.radians(options.camera_pitch)))
    if lean_deg > FLATTEST_DEG:
        parser.error(f"--camera-pitch {options.camera_pitch:g} and --camera-roll {options.camera_roll:g} are together "
                     f"{lean_deg:.1f} degrees from straight down: at most {FLATTEST_DEG:g}")


def parse_arguments(description, arguments):
    parser = argparse.ArgumentParser(prog="mavlink_steps", description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for add in (_add_vehicle, _add_pictures, _add_camera, _add_heights, _add_recording):
        add(parser)
    parser.set_defaults(origin=uuid.uuid4().hex)  # sums of velocities begin anew with each start
    options = parser.parse_args(arguments)
    _check_lean(parser, options)
    _check_recording(parser, options)
    return options
