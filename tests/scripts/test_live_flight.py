#!/usr/bin/python3
"""A whole flight as it would be flown: MAVLink and JPEGs of a banked turn over a rendered town after its earthquake go
through scripts/mavlink_steps and scripts/ground_station to `roadfix serve`, which knows neither place nor heading. The
camera is modelled here from rotation matrices, apart from the program's own model.

usage: test_live_flight.py ROADFIX. Skips (exit 77) where numpy or GDAL is not installed for Python.
"""
import json
import math
import os
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

try:
    import numpy as np
    from osgeo import gdal, osr
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS / "mavlink_steps"))

from crc import crc  # noqa: E402
from packets import MESSAGES  # noqa: E402

gdal.UseExceptions()
PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "roadfix"
AGL_M, ALT_M, COLS, ROWS, FOCAL_PX = 260.0, 912.5, 640, 480, 400.0
RADIUS_M, TURN_RATE = 200.0, 0.1  # 20 m/s to the right
ROLL, PITCH = math.radians(11.0), math.radians(5.0)
ENOUGH, PATIENCE_S = 6, 120.0  # answers of a track that claims its place


def about(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array({"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
                     "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis])


def packet(name, *values):
    number, (_, extra, layout, _) = next((n, m) for n, m in MESSAGES.items() if m[0] == name)
    payload = struct.pack(layout, *values)
    head = bytes([len(payload), 0, 0, 0, 1, 1]) + number.to_bytes(3, "little")
    return b"\xfd" + head + payload + crc(head + payload + bytes([extra])).to_bytes(2, "little")


class Ground:
    """The picture of the town after the earthquake, and where it lies."""

    def __init__(self, file):
        picture = gdal.Open(str(file))
        self.pixels = picture.ReadAsArray()[:3]
        self.west, self.gsd_m, _, self.north, _, _ = picture.GetGeoTransform()
        wgs84 = osr.SpatialReference()
        wgs84.ImportFromEPSG(4326)
        wgs84.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        self._from_wgs84 = osr.CoordinateTransformation(wgs84, osr.SpatialReference(picture.GetProjection()))
        self._to_wgs84 = osr.CoordinateTransformation(osr.SpatialReference(picture.GetProjection()), wgs84)

    def plane(self, pose):
        east, north, _ = self._from_wgs84.TransformPoint(pose["lon"], pose["lat"])
        return north, east

    def global_place(self, north, east):
        """As MAVLink tells it."""
        lon, lat, _ = self._to_wgs84.TransformPoint(east, north)
        return round(1e7 * lat), round(1e7 * lon)

    def seen_from(self, north, east, yaw, mount):
        """What a camera sees that is fixed to the airframe, turned by degrees of yaw, pitch and roll against one that
        looks down through its floor."""
        right, back = np.meshgrid(np.arange(COLS) - 0.5 * (COLS - 1), np.arange(ROWS) - 0.5 * (ROWS - 1))
        rays = np.stack([-back, right, np.full_like(right, FOCAL_PX)], -1)
        camera_yaw, camera_pitch, camera_roll = np.radians(mount)
        airframe = about("z", yaw) @ about("y", PITCH) @ about("x", ROLL)
        rays = rays @ (airframe @ about("z", camera_yaw) @ about("y", camera_pitch) @ about("x", camera_roll)).T
        reach = AGL_M / rays[..., 2]
        col = (east + reach * rays[..., 1] - self.west) / self.gsd_m
        row = (self.north - north - reach * rays[..., 0]) / self.gsd_m
        rows, cols = self.pixels.shape[1:]
        return self.pixels[:, np.clip(row, 0, rows - 1).astype(int), np.clip(col, 0, cols - 1).astype(int)]


class Flight(threading.Thread):
    """Round a circle about the middle of the town, until it is told to end. `truth`: time in microseconds to north,
    east and yaw."""

    def __init__(self, ground, folder, port, mount):
        super().__init__(daemon=True)
        self._ground, self._folder, self._port, self._mount = ground, folder, port, mount
        self._middle = (ground.north - 0.5 * ground.gsd_m * ground.pixels.shape[1],
                        ground.west + 0.5 * ground.gsd_m * ground.pixels.shape[2])
        self.truth = {}
        self.over = threading.Event()

    def _place(self, seconds):
        angle = TURN_RATE * seconds
        return self._middle[0] + RADIUS_M * math.sin(angle), self._middle[1] - RADIUS_M * math.cos(angle), angle

    def run(self):
        began = time.time()
        link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        taken = 0
        while not self.over.wait(0.05):
            seconds = time.time() - began
            north, east, yaw = self._place(seconds)
            lat, lon = self._ground.global_place(north, east)
            boot_ms, speed = round(1e3 * seconds), RADIUS_M * TURN_RATE
            link.sendto(packet("ATTITUDE", boot_ms, ROLL, PITCH, math.remainder(yaw, math.tau)) +
                        packet("LOCAL_POSITION_NED", boot_ms, 5.0, 7.0, -AGL_M, speed * math.cos(yaw),
                               speed * math.sin(yaw), 0.0) +
                        packet("GLOBAL_POSITION_INT", boot_ms, lat, lon, 0, 0) +
                        packet("GPS_RAW_INT", 0, lat, lon, 0, 0, 0, 0, 0, 3) +
                        packet("VFR_HUD", speed, speed, ALT_M), ("127.0.0.1", self._port))
            if seconds > taken + 1:
                taken += 1
                self._take_picture(taken, time.time() - began, began)
        link.close()

    def _take_picture(self, number, seconds, began):
        north, east, yaw = self._place(seconds)
        seen = self._ground.seen_from(north, east, yaw, self._mount)
        memory = gdal.GetDriverByName("MEM").Create("", COLS, ROWS, 3)
        memory.WriteRaster(0, 0, COLS, ROWS, np.ascontiguousarray(seen).tobytes())
        part = str(self._folder / f"{number}.part")
        gdal.GetDriverByName("JPEG").CreateCopy(part, memory, options=["QUALITY=90"])
        os.utime(part, (began + seconds, began + seconds))
        self.truth[round((began + seconds) * 1e6)] = (north, east, yaw)
        os.rename(part, self._folder / f"{number}.jpg")


class LiveFlight(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        (cls.folder / "maps").mkdir()
        for arguments in (["world", cls.folder / "town", "--seed", "3", "--size-km", "1.4x1.4", "--frames", "0"],
                          ["ingest", cls.folder / "town" / "pre.tif", "--map", cls.folder / "maps" / "town.gpkg"]):
            subprocess.run([PROGRAM, *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        cls.ground = Ground(cls.folder / "town" / "post.tif")

    def start(self, *command, **options):
        process = subprocess.Popen(command, text=True, **options)
        self.addCleanup(lambda: [stream.close() for stream in (process.stdout, process.stderr) if stream])
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return process

    def told(self, mount, *recording):
        """Of the places that the track claims: errors in metres, and what the autopilot was told."""
        frames = Path(tempfile.mkdtemp(dir=self.folder))
        service = self.start(PROGRAM, "serve", "--maps", str(self.folder / "maps"), "--port", "0",
                             stdout=subprocess.PIPE)
        address = next(word for word in service.stdout.readline().split() if word.startswith("http://"))
        script = [sys.executable, "-B", "-u"]
        steps = self.start(*script, str(SCRIPTS / "mavlink_steps"), "--listen", "127.0.0.1:0",
                           "--watch", str(frames), "--camera", "body",
                           *(f"--camera-{axis}={angle}" for axis, angle in zip(("yaw", "pitch", "roll"), mount)),
                           *recording, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        port = int(steps.stderr.readline().split()[-1])
        autopilot = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(autopilot.close)
        autopilot.bind(("127.0.0.1", 0))
        autopilot.setblocking(False)
        station = self.start(*script, str(SCRIPTS / "ground_station"), "--server", address, "--map", "town", "--live",
                             "--frame", f"focal_px={FOCAL_PX}", "satellites=10", "--format", "mavproxy",
                             "--max-age", "60", "--send", "127.0.0.1:%d" % autopilot.getsockname()[1],
                             stdin=steps.stdout, stdout=subprocess.PIPE)
        flight = Flight(self.ground, frames, port, mount)
        flight.start()
        self.addCleanup(flight.over.set)
        give_up = time.monotonic() + PATIENCE_S
        errors, positions = [], []
        while len(errors) < ENOUGH and time.monotonic() < give_up:
            answer = json.loads(station.stdout.readline())
            position = json.loads(autopilot.recv(2048))
            if answer["status"] == "converged":
                captured = min(flight.truth, key=lambda time_us: abs(time_us - answer["time_us"]))
                north, east, yaw = flight.truth[captured]
                errors.append(math.dist(self.ground.plane(answer["pose"]), (north, east)))
                positions.append({**position, "true_yaw_deg": math.degrees(yaw)})
        flight.over.set()
        flight.join()
        return errors, positions

    def check(self, mount, *recording):
        errors, positions = self.told(mount, *recording)
        self.assertGreaterEqual(len(errors), ENOUGH)
        self.assertLess(max(errors), 4.0, "the bank alone moves the middle of the frame by 50 m")
        for position in positions:
            self.assertEqual((position["fix_type"], position["satellites_visible"]), (3, 10), "for ArduPilot")
            self.assertAlmostEqual(position["alt"], ALT_M, delta=0.1)
            self.assertLess(abs(math.remainder(0.01 * position["yaw"] - position["true_yaw_deg"], 360.0)), 3.0)

    def benched(self, table):
        """What roadfix answers to the first frames of a table, as roadfix bench compares it with the truth there."""
        (self.folder / "bench.json").write_text(json.dumps({
            "maps": [{"name": "town", "sources": [{"path": "town/pre.tif", "as": "imagery"}]}],
            "queries": [{"map": "town", "frames": str(table)}], "methods": ["roads"]}))
        subprocess.run([PROGRAM, "bench", self.folder / "bench.json", "--limit", "3", "--map-orientations", "1",
                        "--map-cache", self.folder / "cache", "--json", self.folder / "answers.json"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        (result,) = json.loads((self.folder / "answers.json").read_text())["results"]
        return result["queries"]

    def test_is_located_to_metres_in_a_banked_turn(self):
        self.check((0, 0, 0))

    def test_is_located_and_recorded_with_a_camera_that_is_turned_and_tilted_in_the_airframe(self):
        table = self.folder / "flight.csv"
        self.check((90, 20, -4), "--csv", str(table), "--frame", f"focal_px={FOCAL_PX}")
        queries = self.benched(table)
        self.assertEqual([query["status"] for query in queries], 3 * ["fix"])
        for query in queries:
            self.assertLess(query["error_m"], 3.0)
            self.assertLess(query["heading_error_deg"], 2.0)


if __name__ == "__main__":
    unittest.main()
