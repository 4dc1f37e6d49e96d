"""What scripts/demo does once roadfix is built: imagery -> map -> service -> fixes over HTTP, with the truth beside them."""
import argparse
import contextlib
import csv
import json
import math
import pathlib
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass

FALSE_FIX_M = 25.0
DEMO_FOOTPRINT_M = 700  # what a camera of 78 degrees sees from 430 m; smaller ones are honestly refused more often
EARTH_RADIUS_M = 6371008.8
DIRECTLY = ("--noproxy", "*")  # a proxy of the environment would look for the service on itself


class DemoError(Exception):
    """Something that the person at the terminal should read as one line."""


@dataclass
class Frame:
    file: pathlib.Path
    gsd_m: float
    truth: tuple | None = None  # latitude, longitude, heading, all in degrees


def run(*command):
    """Runs a step with its own output shown, so that its progress is seen."""
    text = [str(part) for part in command]
    print("$", shlex.join(text), flush=True)
    status = subprocess.run(text, check=False).returncode
    if status != 0:
        raise DemoError(f"{pathlib.Path(text[0]).name} {text[1]} ended with exit code {status}")


def read_frames(table):
    with open(table, newline="", encoding="utf-8") as lines:
        return [
            Frame(table.parent / row["file"], float(row["gsd_m"]),
                  (float(row["lat"]), float(row["lon"]), float(row["heading_deg"])))
            for row in csv.DictReader(lines)
        ]


def free_port(wanted):
    """Any where none is wanted. Whoever holds the wanted one would be asked in place of the service."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", wanted))
        except (OSError, OverflowError) as problem:
            raise DemoError(f"--port {wanted} cannot be taken: {problem}") from None
        return probe.getsockname()[1]


def curl(*arguments):
    """Status and body of a request made with curl: the command can be repeated as it is printed."""
    command = ["curl", *DIRECTLY, "--silent", "--show-error", "--write-out", "\n%{http_code}", *arguments]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise DemoError(f"no answer from the service: {done.stderr.strip()}")
    body, _, status = done.stdout.rpartition("\n")
    return int(status), body


@contextlib.contextmanager
def service(roadfix, maps, port, log):
    """The running service; it is asked to stop, and waited for, whatever happens meanwhile."""
    command = [str(roadfix), "serve", "--maps", str(maps), "--port", str(port)]
    print("$", shlex.join(command), flush=True)
    with open(log, "wb") as output:
        # A session of its own: Ctrl-C reaches this script, which then asks the service to stop, once.
        process = subprocess.Popen(command, stdout=output, stderr=output, stdin=subprocess.DEVNULL, start_new_session=True)
    try:
        wait_until_ready(process, f"http://127.0.0.1:{port}/readyz", log)
        yield process
    finally:
        process.terminate()
        try:
            process.wait(timeout=15)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def wait_until_ready(process, url, log):
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        if process.poll() is not None:
            raise DemoError(f"the service ended at once with exit code {process.returncode}:\n{tail(log)}")
        with contextlib.suppress(DemoError):
            if curl("--max-time", "2", url)[0] == 200:
                return
        time.sleep(0.1)
    raise DemoError(f"the service was not ready after a minute:\n{tail(log)}")


def tail(log):
    return "\n".join(log.read_text(errors="replace").splitlines()[-15:])


def distance_m(a, b):
    """Great circle between two (latitude, longitude, ...) in degrees."""
    lat_a, lat_b = math.radians(a[0]), math.radians(b[0])
    half = (math.sin((lat_b - lat_a) / 2) ** 2
            + math.cos(lat_a) * math.cos(lat_b) * math.sin(math.radians(b[1] - a[1]) / 2) ** 2)
    return 2 * EARTH_RADIUS_M * math.asin(math.sqrt(half))


def pose_text(pose):
    return f"{pose[0]:10.6f} {pose[1]:11.6f} {pose[2]:6.1f}" if pose else f"{'-':>10} {'-':>11} {'-':>6}"


def ask(base, frame, first):
    url = f"{base}/fix?kind=frame&gsd_m={frame.gsd_m:g}"
    kind = "image/jpeg" if frame.file.suffix.lower() in (".jpg", ".jpeg") else "image/png"
    arguments = ["--data-binary", f"@{frame.file}", "-H", f"Content-Type: {kind}", url]
    if first:
        print("$ curl", shlex.join([*DIRECTLY, *arguments]), "\n", flush=True)
        print(f"{'frame':<16} {'true lat':>10} {'lon':>11} {'head':>6} | {'answer':<9} {'lat':>10} {'lon':>11} {'head':>6}"
              f" | {'error':>8} {'head':>6} {'prob':>6} {'time':>7}")
    status, body = curl(*arguments)
    if status != 200:
        raise DemoError(f"the service answered {status} for {frame.file.name}: {body}")
    return json.loads(body)


def report(frame, answer):
    """Prints one row; returns the position error in metres where there is one."""
    pose = answer.get("pose")
    pose = (pose["lat"], pose["lon"], pose["heading_deg"]) if pose and answer["status"] == "fix" else None
    error = distance_m(frame.truth, pose) if frame.truth and pose else None
    turned = abs((pose[2] - frame.truth[2] + 180) % 360 - 180) if error is not None else None
    probability = answer.get("probability")
    note = answer.get("reason", "")
    if pose is None and frame.truth and answer.get("modes"):
        guess = answer["modes"][0]["pose"]
        note += f"; the best guess is {distance_m(frame.truth, (guess['lat'], guess['lon'])):.1f} m off"
    print(f"{frame.file.name[:16]:<16} {pose_text(frame.truth)} | {answer['status']:<9} {pose_text(pose)} | "
          + (f"{error:6.1f} m {turned:5.1f}°" if error is not None else f"{'-':>8} {'-':>6}")
          + (f" {probability:6.3f}" if probability is not None else f" {'-':>6}")
          + f" {sum(answer.get('time_ms', {}).values()):4.0f} ms  {note}", flush=True)
    return error


def ask_all(base, frames):
    errors, fixes = [], 0
    for i, frame in enumerate(frames):
        answer = ask(base, frame, first=i == 0)
        fixes += answer["status"] == "fix"
        errors.append(report(frame, answer))
    known = [error for error in errors if error is not None]
    right = sum(error <= FALSE_FIX_M for error in known)
    checked = f"{right} within {FALSE_FIX_M:g} m, {len(known) - right} wrong"
    if fixes and not known:
        checked = "whether rightly is for you to see, since the true places are not known"
    print(f"\nframes: {len(frames)}, answered with a fix: {fixes}; {checked}", flush=True)
    return right


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/demo", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="A map from imagery, the service, and fixes over HTTP. Without IMAGE: a rendered city before and after an earthquake.",
        epilog="examples:\n  scripts/demo --once\n  scripts/demo before.tif --after after.tif\n  scripts/demo city.tif --frame drone.png --gsd 0.3")
    parser.add_argument("images", nargs="*", metavar="IMAGE", type=pathlib.Path, help="georeferenced imagery to make the map from")
    parser.add_argument("--after", type=pathlib.Path, metavar="IMAGE",
                        help="georeferenced imagery of a later day to cut the frames from (default: the map's own imagery)")
    parser.add_argument("--frame", action="append", type=pathlib.Path, default=[], metavar="FILE", help="a frame of yours (PNG or JPEG)")
    parser.add_argument("--gsd", type=float, metavar="METRES", help="size of a pixel of --frame on the ground")
    parser.add_argument("--frames", type=int, default=8, metavar="N", help="frames to ask for (default: 8)")
    parser.add_argument("--seed", type=int, default=1, help="for the rendered city and the places of the frames (default: 1)")
    parser.add_argument("--port", type=int, help="port of the service (default: a free one)")
    parser.add_argument("--once", action="store_true", help="end after the answers")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="put imagery, map and log there and leave them (default: a temporary folder)")
    parser.add_argument("--roadfix", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.frame and arguments.gsd is None:
        parser.error("--frame needs --gsd, the size of its pixels in metres")
    if (arguments.frame or arguments.after) and not arguments.images:
        parser.error("--frame and --after need the IMAGE that the map is made from")
    if arguments.frames < 1:
        parser.error("--frames: ask for one at least")
    for file in arguments.frame:
        if file.is_dir():
            parser.error(f"{file} is a folder: name each of its frames with a --frame of its own")
    for file in arguments.images + arguments.frame + [arguments.after]:
        if file is not None and not file.exists():
            parser.error(f"there is no file {file}")
    return arguments


def prepare(arguments, work):
    """The sources of the map and the frames to ask for."""
    if not arguments.images:
        run(arguments.roadfix, "world", work / "world", "--seed", arguments.seed,
            "--frames", arguments.frames, "--footprint-m", DEMO_FOOTPRINT_M)
        return [work / "world" / "pre.tif"], read_frames(work / "world" / "frames" / "frames.csv")
    frames = [Frame(file, arguments.gsd) for file in arguments.frame]
    if not frames:
        from cut_frames import cut_frames  # needs python3-gdal, which nothing else here does
        source = arguments.after or arguments.images[0]
        if not arguments.after:
            print("the frames are cut from the map's own imagery: this shows the chain, not how well it does on another day")
        try:
            frames = [Frame(*cut) for cut in cut_frames(source, work / "frames", arguments.frames, arguments.seed)]
        except (ValueError, RuntimeError) as problem:  # the second is GDAL's
            raise DemoError(f"no frames can be cut ({problem}): name a georeferenced image with --after, or give "
                            "frames of yours with --frame and --gsd") from None
    return arguments.images, frames


def demo(arguments, work):
    made = work / "maps" / "demo.gpkg"
    if made.exists():
        raise DemoError(f"{made} is the map of an earlier demo: remove it, or --keep another folder")
    port = free_port(arguments.port or 0)
    sources, frames = prepare(arguments, work)
    made.parent.mkdir(exist_ok=True)
    run(arguments.roadfix, "ingest", *sources, "--map", made)
    with service(arguments.roadfix, made.parent, port, work / "serve.log") as process:
        host = f"http://127.0.0.1:{port}"
        right = ask_all(f"{host}/v1/maps/demo", frames)
        if right == 0 and not arguments.images:
            raise DemoError("not one frame of the rendered town was placed, which is not how it should be")
        if arguments.once:
            return
        print(f"""
Open in a browser or a GIS, until Ctrl-C:
  {host}/                                     what is served
  {host}/v1/maps/demo                         the map, its extent and its sources
  {host}/v1/maps/demo/tilejson.json           the tiles for MapLibre, Leaflet, QGroundControl
  {host}/v1/maps/demo/tiles/{{z}}/{{x}}/{{y}}.png   the tiles for QGIS (XYZ connection)
  {host}/openapi.json                         every route
  {made}   the map itself, for QGIS""", flush=True)
        try:
            process.wait()
        except KeyboardInterrupt:
            print("\nstopped")
            return
        raise DemoError(f"the service ended by itself with exit code {process.returncode}:\n{tail(work / 'serve.log')}")


def main():
    arguments = parse_arguments()
    for ending in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(ending) != signal.SIG_IGN:  # as nohup has it
            signal.signal(ending, lambda number, _: sys.exit(128 + number))
    try:
        work = arguments.keep or pathlib.Path(tempfile.mkdtemp(prefix="roadfix-demo-"))
        work.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        sys.exit(f"demo: no folder for its files: {problem}")
    try:
        demo(arguments, work.resolve())
    except KeyboardInterrupt:
        sys.exit("\ndemo: stopped before its answers")
    except DemoError as error:
        sys.exit(f"demo: {error}")
    finally:
        if not arguments.keep:
            shutil.rmtree(work, ignore_errors=True)


if __name__ == "__main__":
    main()
