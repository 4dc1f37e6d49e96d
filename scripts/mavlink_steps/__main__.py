"""Makes steps for scripts/ground_station of what an autopilot tells by MAVLink and of pictures that a camera writes into
a folder: a line of JSON for each picture.

  mkdir -p frames
  ffmpeg -nostdin -flags low_delay -i rtsp://CAMERA/stream -vf fps=1 -threads 1 "frames/$(date +%s)-%06d.jpg" &
  python3 scripts/mavlink_steps --listen 14551 --watch frames --every 1 --camera level |
    python3 scripts/ground_station --map city --frame fov_deg=78 --live

Movements are the sum of velocities: of LOCAL_POSITION_NED, unless ESTIMATOR_STATUS (PX4) or EKF_STATUS_REPORT
(ArduPilot) says that they do not count, or with --by-air of airspeed and heading (VFR_HUD, ATTITUDE; give the track
wind_sigma_m_s). Heights are those above ground of ALTITUDE (PX4) or TERRAIN_REPORT (ArduPilot), else above the take-off.
That above the sea, which goes to the autopilot with each position, is that of ALTITUDE or VFR_HUD. A picture was taken
when its file was last written, less --delay.

With --csv the flight of a vehicle that has GPS becomes a table of its pictures with their places, those of
GLOBAL_POSITION_INT while GPS_RAW_INT tells a 3D fix. Send the autopilot no positions meanwhile: they would be its own.
"""
import contextlib
import errno
import math
import os
import select
import socket
import sys
import time

from autopilot import Autopilot
from clock import WallClock
from gimbal import Gimbal
from lines import Lines
from link import LinkSilence
from log import Log
from options import parse_arguments
from packets import Stream
from pictures import NewPictures, Silence
from receiver import Receiver
from recording import Recording, columns
from table import Table
from vehicle import Vehicle

LOOK_S = 0.1       # between two looks into the folder
MOST_HEARD = 1000  # datagrams between them, so that a flood of them leaves time to look


def listen(link, address):
    """Throws OSError that says where."""
    try:
        link.bind(address)
    except OSError as error:
        question = ": does another program, as a ground station, listen there? Let the autopilot send to another port"
        why = f"{error.strerror or error}{question if error.errno == errno.EADDRINUSE else ''}"
        raise OSError(f"--listen {address[0]}:{address[1]}: {why}") from None


def hear(link, stream, receiver):
    """Takes all that has come: a look into a full folder takes as long as many messages need to come."""
    for _ in range(MOST_HEARD):
        try:
            datagram = link.recv(65535)
        except BlockingIOError:
            return
        came = time.monotonic()
        for message in stream.messages(datagram):
            receiver.take(message, came)


def follow(link, pictures, table, clock, options):
    """`table`: None where the flight is not recorded."""
    vehicle = Vehicle(options.by_air, options.takeoff_agl)
    autopilot = Autopilot(options.system, options.component)
    gimbal = Gimbal(options.gimbal) if options.camera == "gimbal" else None
    receiver = Receiver(autopilot, vehicle, gimbal)
    stream = Stream()
    recording = Recording(table, vehicle, options) if table else None
    lines = Lines(vehicle, gimbal, autopilot, clock, options, recording)
    silence = Silence(options.watch)
    link_silence = LinkSilence(options.listen[1])
    came = looked = -math.inf
    while True:
        if select.select([link], [], [], LOOK_S)[0]:
            came = time.monotonic()
            hear(link, stream, receiver)
        if time.monotonic() < looked + LOOK_S:
            continue
        clock.look()
        link_silence.look(came, vehicle.heard)
        new = pictures()
        silence.look(pictures.have_come, vehicle.heard)
        for path, written in new:
            lines.add(path, written - options.delay)
        lines.print_due()
        if recording:
            recording.write_due()
        looked = time.monotonic()


def main(arguments=None):
    options = parse_arguments(__doc__, arguments)
    sys.stderr = Log(sys.stderr)
    clock = WallClock()
    try:
        pictures = NewPictures(options.watch, clock, options.every)
        family = socket.AF_INET6 if ":" in options.listen[0] else socket.AF_INET
        with contextlib.ExitStack() as opened:
            link = opened.enter_context(socket.socket(family, socket.SOCK_DGRAM))
            listen(link, options.listen)
            link.setblocking(False)
            table = opened.enter_context(Table(options.csv, columns(options))) if options.csv else None
            print(f"listening on UDP port {link.getsockname()[1]}", file=sys.stderr)
            follow(link, pictures, table, clock, options)
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
