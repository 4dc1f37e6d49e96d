"""Makes steps for scripts/ground_station of what an autopilot tells by MAVLink and of pictures that a camera writes into
a folder: a line of JSON for each picture.

  mkdir -p frames
  ffmpeg -nostdin -flags low_delay -i rtsp://CAMERA/stream -vf fps=1 -threads 1 "frames/$(date +%s)-%06d.jpg" &
  python3 scripts/mavlink_steps --listen 14551 --watch frames --every 1 --camera level |
    python3 scripts/ground_station --map city --frame fov_deg=78 --live

Movements are the sum of velocities: of LOCAL_POSITION_NED, or with --by-air of airspeed and heading (VFR_HUD, ATTITUDE;
give the track wind_sigma_m_s). Heights are those above ground of ALTITUDE (PX4) or TERRAIN_REPORT (ArduPilot), else
above the take-off. That above the sea, which goes to the autopilot with each position, is that of ALTITUDE or VFR_HUD.
A picture was taken when its file was last written, less --delay.
"""
import argparse
import math
import os
import select
import socket
import sys
import time
import uuid

from autopilot import Autopilot
from clock import WallClock
from gimbal import STATUS, Gimbal
from lines import Lines
from link import LinkSilence
from log import Log
from packets import messages
from pictures import NewPictures, Silence
from receiver import Receiver
from vehicle import Vehicle

LOOK_S = 0.1       # between two looks into the folder
MOST_HEARD = 1000  # datagrams between them, so that a flood of them leaves time to look


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


def parse_interval(text):
    interval_s = parse_number(text)
    if interval_s <= 0.0:
        raise argparse.ArgumentTypeError(f"'{text}': write more than 0")
    return interval_s


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(prog="mavlink_steps", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--listen", type=parse_address, default=("0.0.0.0", 14551), metavar="[HOST:]PORT",
                        help="where MAVLink comes in by UDP (default: 14551)")
    parser.add_argument("--watch", required=True, metavar="FOLDER", help="folder into which the camera writes")
    parser.add_argument("--system", type=int, choices=range(1, 256), metavar="ID",
                        help="the vehicle's system id (default: that of the first message)")
    parser.add_argument("--component", type=int, default=1,
                        help="the autopilot's component id; others of the system are ignored (default: %(default)d)")
    parser.add_argument("--camera", choices=("body", "level", "gimbal"), required=True,
                        help="body: fixed to the airframe, looking down; level: held straight down by a gimbal that "
                             "follows the nose; gimbal: as the gimbal tells (" + STATUS + ")")
    parser.add_argument("--gimbal", type=int, metavar="ID",
                        help="of --camera gimbal: the gimbal's id, which is that of its component, or 1 to 6 where the "
                             "autopilot answers for it (default: that of the first message)")
    parser.add_argument("--camera-yaw", type=parse_number, default=0.0, metavar="DEGREES",
                        help="where the picture's upper edge points, clockwise from the nose, or from where "
                             "a gimbal says that it points (default: 0)")
    parser.add_argument("--by-air", action="store_true", help="movements by airspeed and heading")
    ground = parser.add_mutually_exclusive_group()
    ground.add_argument("--agl", type=parse_number, metavar="M",
                        help="height above ground, instead of what the autopilot tells")
    ground.add_argument("--by-terrain", action="store_true",
                        help="the map knows how high its ground is (roadfix terrain): tell the height above the sea "
                             "alone")
    parser.add_argument("--takeoff-agl", type=parse_number, default=0.0, metavar="M",
                        help="how much higher than the ground in the pictures the take-off lay (default: 0)")
    parser.add_argument("--delay", type=parse_delay, default=0.0, metavar="S",
                        help="from the capture of a picture to its file (default: 0)")
    parser.add_argument("--every", type=parse_interval, metavar="S",
                        help="seconds between pictures, by which their names are numbered, as of ffmpeg with fps=1/S: "
                             "those that come later and later are left out (default: by their EXIF, where they have "
                             "some)")
    parser.set_defaults(origin=uuid.uuid4().hex)  # sums of velocities begin anew with each start
    return parser.parse_args(arguments)


def hear(link, receiver):
    """Takes all that has come: a look into a full folder takes as long as many messages need to come."""
    for _ in range(MOST_HEARD):
        try:
            datagram = link.recv(65535)
        except BlockingIOError:
            return
        came = time.monotonic()
        for message in messages(datagram):
            receiver.take(message, came)


def follow(link, pictures, clock, options):
    vehicle = Vehicle(options.by_air, options.takeoff_agl)
    autopilot = Autopilot(options.system, options.component)
    gimbal = Gimbal(options.gimbal) if options.camera == "gimbal" else None
    receiver = Receiver(autopilot, vehicle, gimbal)
    lines = Lines(vehicle, gimbal, autopilot, clock, options)
    silence = Silence(options.watch)
    link_silence = LinkSilence(options.listen[1])
    came = looked = -math.inf
    while True:
        if select.select([link], [], [], LOOK_S)[0]:
            came = time.monotonic()
            hear(link, receiver)
        if time.monotonic() < looked + LOOK_S:
            continue
        clock.look()
        link_silence.look(came, vehicle.heard)
        new = pictures()
        silence.look(pictures.have_come, vehicle.heard)
        for path, written in new:
            lines.add(path, written - options.delay)
        lines.print_due()
        looked = time.monotonic()


def main(arguments=None):
    options = parse_arguments(arguments)
    sys.stderr = Log(sys.stderr)
    clock = WallClock()
    try:
        pictures = NewPictures(options.watch, clock, options.every)
        family = socket.AF_INET6 if ":" in options.listen[0] else socket.AF_INET
        with socket.socket(family, socket.SOCK_DGRAM) as link:
            link.bind(options.listen)
            link.setblocking(False)
            print(f"listening on UDP port {link.getsockname()[1]}", file=sys.stderr)
            follow(link, pictures, clock, options)
    except BrokenPipeError:  # nobody reads the steps any more
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except OSError as error:
        print(f"mavlink_steps: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
