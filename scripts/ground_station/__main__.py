"""A client of `roadfix serve` for ground stations and companion computers, in Python's standard library alone: a line
of JSON in for each step, a line with the answer out, which names the step's picture ("image").

  {"time_us": 1700000000000000, "north_m": 12.5, "east_m": -3.0, "yaw_deg": 91.2, "image": "0001.jpg"}

- north_m, east_m, yaw_deg: where the vehicle's own estimator believes to be, in its local frame. Origin and drift of
  the frame do not matter: steps say the movement since the last one. yaw_deg, clockwise from north, is that of the
  picture's upper edge. A line with a picture may leave out all three: how the vehicle moved is then not known.
- origin: any text that is another one once the frame has another origin, as after a restart of the estimator. The track
  then begins anew around the last place that was known.
- image: PNG or JPEG, relative to the folder of the file of steps. Without one the step is dead reckoning.
- time_us: when the frame was captured, increasing. Without it: when the line came.
- monotonic_s: the same by CLOCK_MONOTONIC of this computer, for the age of positions; it is not sent.
- covariance: of the movement from the line before, as a step has it; those of lines that are not sent are added.
- All other members are fields of a step as /openapi.json describes them: agl_m, roll_deg, pitch_deg, alt_m,
  camera_yaw_deg ...
"""
import argparse
import functools
import json
import pathlib
import sys

from log import Log
from output import FlightOutput, ReadOutput
from positions import FORMATS_WITH_AGE, FORMATS_WITHOUT_AGE, Sender
from preflight import check
from service import Refused, Service, Silent
from steps import NewestLine, all_lines, captured, place_and_covariance, read_step
from track import Track, WrongTrack
from trial import try_out

LARGEST_PORT = 65535  # a larger one would be cut to another


def parse_setting(text):
    """NAME=VALUE, the value as JSON where it is some."""
    name, equals, value = text.partition("=")
    if not name or not equals:
        raise argparse.ArgumentTypeError(f"'{text}': write NAME=VALUE, and the file of steps before all options")
    try:
        return name, json.loads(value)
    except ValueError:
        return name, value


def parse_address(text):
    host, colon, port = text.rpartition(":")
    if not host or not colon or not port.isdigit() or int(port) > LARGEST_PORT:
        raise argparse.ArgumentTypeError(f"'{text}': write HOST:PORT")
    return host.strip("[]"), int(port)


def parse_seconds(text):
    seconds = float(text)
    if not seconds >= 0.0:
        raise argparse.ArgumentTypeError(f"'{text}': write a number of seconds")
    return seconds


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="ground_station", usage="%(prog)s [steps] --map MAP [option ...]", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="example: python3 scripts/ground_station --map city --track lat=37.76 lon=38.27 radius_m=2000 "
               "--frame fov_deg=78 roll_deg=0 pitch_deg=0 --live --format gps_input --send 127.0.0.1:14550 < steps")
    parser.add_argument("steps", nargs="?", help="file of steps (default: standard input)")
    parser.add_argument("--server", default="http://127.0.0.1:8080",
                        help="address of the service, with user:password@ for a proxy that asks (default: %(default)s)")
    parser.add_argument("--map", required=True, help="name of the map")
    parser.add_argument("--track", nargs="+", type=parse_setting, default=[], metavar="NAME=VALUE",
                        help="where the track begins and what the vehicle is: lat, lon and radius_m, scale_range and "
                             "other members of POST /v1/tracks (default: anywhere on the map)")
    parser.add_argument("--frame", nargs="+", type=parse_setting, default=[], metavar="NAME=VALUE",
                        help="what is the same of all pictures: fov_deg, gsd_m, exif=true, cell_m of feature maps ..., "
                             "and of all positions: satellites ...")
    parser.add_argument("--live", action="store_true",
                        help="of the steps that wait send only the newest; without it all of them, as of a recording")
    parser.add_argument("--state", help="file that keeps the track, so that a client that is started again goes on with it")
    parser.add_argument("--patience", type=parse_seconds, default=60.0, metavar="S",
                        help="retry a step for S seconds while the service is unreachable or busy (default: %(default)g; "
                             "keep 60 or more: a search can take 30 s). Half of what is left is the time for an "
                             "answer; a repetition gets what the service has computed meanwhile")
    parser.add_argument("--format", choices=(*FORMATS_WITHOUT_AGE, *FORMATS_WITH_AGE),
                        help="message for the autopilot (docs/tracks.md)")
    parser.add_argument("--send", type=parse_address, metavar="HOST:PORT", help="where to send it by UDP")
    parser.add_argument("--max-age", type=parse_seconds, default=0.5, metavar="S",
                        help="drop positions older than S seconds from capture (monotonic_s, else time_us where it is "
                             "of this computer's clock, else when its line came) to sending (default: %(default)g); of "
                             + " and ".join(FORMATS_WITH_AGE) + ", which say how old they are, the time that the "
                             "service took is not counted")
    parser.add_argument("--check", action="store_true",
                        help="only look whether the service has the map and --track begins on it, as is done before "
                             "each flight, and whether it takes --track and --frame, by a track that is removed again")
    options = parser.parse_args(arguments)
    if (options.format is None) != (options.send is None):
        parser.error("--format and --send go together")
    if "map" in dict(options.track):
        parser.error("--track map: the map is that of --map")
    if dict(options.track).get("known_start") and not options.state:
        parser.error("--track known_start goes with --state: a client that is started again in flight would vouch for "
                     "the place of the take-off without it")
    return options


def request_of(options):
    """Of a track."""
    return {"map": options.map, **dict(options.track)}


def fly(lines, options):
    """Whether all steps were taken and their answers printed."""
    sender = Sender(options.format, options.send, options.max_age) if options.send else None
    service = Service(options.server, options.patience)
    track = Track(service, request_of(options), options.state,
                  lambda track_id: print(f"a track begins: {service.page_of(track_id)}", file=sys.stderr, flush=True))
    folder = pathlib.Path(options.steps or ".").parent
    frame_fields = dict(options.frame)
    output = FlightOutput() if sender else ReadOutput()
    all_taken = True
    for line in NewestLine(lines) if options.live else all_lines(lines):
        for passed in line.passed:
            track.pass_by(*place_and_covariance(passed, frame_fields))
        try:
            step = read_step(line, folder, frame_fields)
        except (ValueError, OSError) as error:
            track.pass_by(*place_and_covariance(line, frame_fields))
            print(f"{line.name}: {error}", file=sys.stderr)
            all_taken = False
            continue
        try:
            if sender:
                sender.expect(step.fields)
            send = functools.partial(sender.send, captured(line, step.fields)) if sender else None
            answer = track.step(step.place, step.fields, step.image, step.origin, options.format, send)
        except (ValueError, OSError, Refused, Silent) as error:
            print(f"{line.name}: {error}", file=sys.stderr)
            all_taken = False
            continue
        output.print({**answer, "image": line.step["image"]} if line.has_picture else answer)
    return output.finish() and all_taken


def main(arguments=None):
    options = parse_arguments(arguments)
    sys.stderr = Log(sys.stderr)
    try:
        can_follow = check(options.server, request_of(options), dict(options.frame))
        if options.check:
            if can_follow:
                try_out(Service(options.server, options.patience), request_of(options), dict(options.frame))
            return 0 if can_follow else 1
        if options.steps is None:
            sys.stdin.reconfigure(encoding="utf-8", errors="replace")  # a bad byte spoils its line alone
            return 0 if fly(sys.stdin, options) else 1
        with open(options.steps, encoding="utf-8", errors="replace") as lines:
            return 0 if fly(lines, options) else 1
    except BrokenPipeError:  # nobody reads the answers any more
        return 1
    except (ValueError, OSError, Refused, Silent, WrongTrack) as error:
        print(f"ground_station: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
