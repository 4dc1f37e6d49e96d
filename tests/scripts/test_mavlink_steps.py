#!/usr/bin/python3
"""MAVLink to steps: packets of the public implementation node-mavlink 2.3.0, angles against rotation matrices, a flight
whose truth is known, and the program with a socket and a folder."""
import json
import math
import os
import random
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"
sys.path.insert(0, str(PROGRAM))

from packets import MESSAGES, crc, messages  # noqa: E402
from pictures import NewPictures  # noqa: E402
from vehicle import Unknown, Vehicle, turned  # noqa: E402

# system 7, component 1
ATTITUDE = bytes.fromhex(
    "fd1c00000307011e000040e201000000003e000080bd0000c03f00000000000000000000803eddd5")
ATTITUDE_OF_VERSION_1 = bytes.fromhex(
    "fe1c0307011e40e201000000003e000080bd0000c03f00000000000000000000803e3148")
LOCAL_POSITION = bytes.fromhex(
    "fd1800000407012000006ce201000000803f00000040004096c300004841000050c00fba")  # the last zeros are left out
OTHERS = {
    "VFR_HUD": (bytes.fromhex("fd1300000507014a000000008c410000a04100000044000000005a003768b6"), "airspeed", 17.5),
    "TERRAIN_REPORT": (bytes.fromhex("fd1500000607018800007b358216d395cd160000164400209b436400000054823c"),
                       "current_height", 310.25),
    "ALTITUDE": (bytes.fromhex("fd2000000707018d000015cd5b07000000000000803f0000004000004040000080400000a04000c08f43"
                               "759e"), "bottom_clearance", 287.5),
}


def packet(name, *values, system=7):
    number, (_, extra, layout, _) = next((n, m) for n, m in MESSAGES.items() if m[0] == name)
    payload = struct.pack(layout, *values)
    head = bytes([len(payload), 0, 0, 0, system, 1]) + number.to_bytes(3, "little")
    return b"\xfd" + head + payload + crc(head + payload + bytes([extra])).to_bytes(2, "little")


class Packets(unittest.TestCase):
    def test_of_both_versions_are_read_as_another_implementation_writes_them(self):
        for data in (ATTITUDE, ATTITUDE_OF_VERSION_1):
            (message,) = messages(data)
            self.assertEqual(message[:3], (7, 1, "ATTITUDE"))
            self.assertEqual(message.fields, {"time_boot_ms": 123456, "roll": 0.125, "pitch": -0.0625, "yaw": 1.5})
        (message,) = messages(LOCAL_POSITION)
        self.assertEqual(message.fields, {"time_boot_ms": 123500, "x": 1.0, "y": 2.0, "z": -300.5, "vx": 12.5,
                                          "vy": -3.25, "vz": 0.0})
        for name, (data, field, value) in OTHERS.items():
            (message,) = messages(data)
            self.assertEqual((message.name, message.fields[field]), (name, value))

    def test_are_found_among_others_and_rubbish(self):
        unknown = b"\xfd\x04\x00\x00\x00\x07\x01\x00\x00\x00" + bytes(6)
        signed = ATTITUDE[:2] + b"\x01" + ATTITUDE[3:-2]
        signed += crc(signed[1:] + b"\x27").to_bytes(2, "little") + bytes(13)
        data = b"\xfd\xfe\x00" + unknown + signed + ATTITUDE_OF_VERSION_1 + LOCAL_POSITION + b"\xfe"
        self.assertEqual([m.name for m in messages(data)], ["ATTITUDE", "ATTITUDE", "LOCAL_POSITION_NED"])

    def test_that_are_damaged_are_left_out_whatever_the_damage(self):
        draw = random.Random(2)
        for _ in range(2000):
            data = bytearray(ATTITUDE + LOCAL_POSITION)
            for _ in range(draw.randrange(1, 4)):
                data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
            del data[draw.randrange(len(data)):]
            for message in messages(bytes(data)):
                self.assertIn(message, list(messages(ATTITUDE + LOCAL_POSITION)))


def about(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return {0: ((1, 0, 0), (0, c, -s), (0, s, c)), 1: ((c, 0, s), (0, 1, 0), (-s, 0, c)),
            2: ((c, -s, 0), (s, c, 0), (0, 0, 1))}[axis]


def product(*matrices):
    result, *others = matrices
    for other in others:
        result = tuple(tuple(sum(row[k] * other[k][j] for k in range(3)) for j in range(3)) for row in result)
    return result


def rotation(roll, pitch, yaw):
    return product(about(2, yaw), about(1, pitch), about(0, roll))


class Camera(unittest.TestCase):
    def test_that_is_turned_in_the_airframe_has_the_attitude_of_both_rotations(self):
        draw = random.Random(3)
        for _ in range(300):
            attitude = (draw.uniform(-1.4, 1.4), draw.uniform(-1.4, 1.4), draw.uniform(-9, 9))
            yaw = draw.uniform(-4, 4)
            expected = product(rotation(*attitude), about(2, yaw))
            actual = rotation(*turned(attitude, yaw))
            for row, other in zip(actual, expected):
                for a, b in zip(row, other):
                    self.assertAlmostEqual(a, b, places=9)


class Flights(unittest.TestCase):
    def test_round_a_circle_come_back_whatever_the_links_delays(self):
        draw = random.Random(4)
        vehicle = Vehicle()
        radius_m, rate = 100.0, math.tau / 60.0  # once a minute
        for i in range(601):
            t = 0.1 * i
            came = 1000.0 + t + (0.0 if i % 7 == 0 else draw.uniform(0.0, 0.05))
            yaw = math.remainder(rate * t, math.tau)
            vehicle.hear("ATTITUDE", {"time_boot_ms": round(1e3 * t), "roll": 0.1, "pitch": 0.0, "yaw": yaw}, came)
            velocity = (radius_m * rate * math.cos(rate * t), radius_m * rate * math.sin(rate * t))
            vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": round(1e3 * t), "z": -80.0, "vx": velocity[0],
                                                "vy": velocity[1]}, came)
        for t in (15.03, 30.0, 44.97, 59.9):
            (north, east), (roll, _, yaw) = vehicle.seen_at(1000.0 + t)
            self.assertAlmostEqual(north, radius_m * math.sin(rate * t), delta=0.15)
            self.assertAlmostEqual(east, radius_m * (1.0 - math.cos(rate * t)), delta=0.15)
            self.assertAlmostEqual(math.remainder(yaw - rate * t, math.tau), 0.0, delta=0.002)
            self.assertAlmostEqual(roll, 0.1)
        self.assertEqual(vehicle.agl_m(), 80.0)

    def test_by_air_go_where_the_nose_points(self):
        vehicle = Vehicle(by_air=True)
        for i in range(11):
            vehicle.hear("ATTITUDE", {"time_boot_ms": 100 * i, "roll": 0, "pitch": 0, "yaw": 0.5 * math.pi}, 5.0 + 0.1 * i)
            vehicle.hear("VFR_HUD", {"airspeed": 20.0}, 5.0 + 0.1 * i)
            vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": 100 * i, "z": -9, "vx": 3.0, "vy": 0.0}, 5.0 + 0.1 * i)
        (north, east), _ = vehicle.seen_at(6.0)
        self.assertAlmostEqual(north, 0.0, places=6)
        self.assertAlmostEqual(east, 20.0, places=6)

    def test_are_high_above_ground_where_the_autopilot_knows_it_and_else_above_the_take_off(self):
        vehicle = Vehicle(takeoff_agl_m=12.0)
        with self.assertRaises(Unknown):
            vehicle.agl_m()
        vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": 0, "z": -80.0, "vx": 0.0, "vy": 0.0}, 1.0)
        self.assertEqual(vehicle.agl_m(), 92.0)
        vehicle.hear("TERRAIN_REPORT", {"spacing": 0, "current_height": 0.0}, 1.0)
        vehicle.hear("ALTITUDE", {"bottom_clearance": math.nan}, 1.0)
        self.assertEqual(vehicle.agl_m(), 92.0, "neither knows the ground")
        vehicle.hear("TERRAIN_REPORT", {"spacing": 100, "current_height": 70.0}, 1.0)
        self.assertEqual(vehicle.agl_m(), 70.0)

    def test_are_unknown_where_nothing_was_heard(self):
        vehicle = Vehicle()
        for boot_ms in (0, 1000, 21000, 22000):
            vehicle.hear("ATTITUDE", {"time_boot_ms": boot_ms, "roll": 0, "pitch": 0, "yaw": 0}, boot_ms / 1e3)
            vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": boot_ms, "z": 0, "vx": 1, "vy": 0}, boot_ms / 1e3)
        self.assertAlmostEqual(vehicle.longest_hole_s(), 20.0)
        self.assertEqual(vehicle.longest_hole_s(), 0.0)
        self.assertAlmostEqual(vehicle.seen_at(0.5)[0][0], 0.5)
        for when in (-5.0, 10.0, 25.0):
            with self.assertRaises(Unknown):
                vehicle.seen_at(when)

    def test_outlast_a_restart_of_the_autopilot(self):
        vehicle = Vehicle()
        for came, boot_ms in ((100.0, 90_000), (101.0, 91_000), (103.0, 500), (104.0, 1500)):
            vehicle.hear("ATTITUDE", {"time_boot_ms": boot_ms, "roll": 0, "pitch": 0, "yaw": 0}, came)
            vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": boot_ms, "z": 0, "vx": 2, "vy": 0}, came)
        self.assertAlmostEqual(vehicle.seen_at(104.0)[0][0], 8.0, places=2)


class Pictures(unittest.TestCase):
    def test_are_taken_once_they_are_whole_in_the_order_they_were_written(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "old.jpg").write_bytes(b"\xff\xd8\xff\xd9")
            new = NewPictures(folder)
            Path(folder, "b.JPG").write_bytes(b"\xff\xd8\xff\xd9")
            Path(folder, "a.png").write_bytes(b"\x89PNG IEND\xaeB`\x82")
            Path(folder, "half.jpg").write_bytes(b"\xff\xd8\xff")
            Path(folder, "notes.txt").write_bytes(b"\xff\xd9")
            os.utime(Path(folder, "b.JPG"), (50, 50))
            os.utime(Path(folder, "a.png"), (60, 60))
            self.assertEqual([(path.name, written) for path, written in new()], [("b.JPG", 50), ("a.png", 60)])
            self.assertEqual(new(), [])
            with open(Path(folder, "half.jpg"), "ab") as rest:
                rest.write(b"\xd9")
            self.assertEqual([path.name for path, _ in new()], ["half.jpg"])
            Path(folder, "odd.jpg").write_bytes(b"\xff\xd8 and no end")
            os.utime(Path(folder, "odd.jpg"), (70, 70))
            self.assertEqual([path.name for path, _ in new()], ["odd.jpg"], "nothing was written for long")


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.program = subprocess.Popen(
            [sys.executable, "-B", str(PROGRAM), "--listen", "127.0.0.1:0", "--watch", self.folder.name, "--camera", "body"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: [self.program.wait(), self.program.stdout.close(), self.program.stderr.close()])
        self.addCleanup(self.program.terminate)
        self.port = int(self.program.stderr.readline().split()[-1])
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.link.close)

    def tell(self, boot_ms, system=7):
        self.link.sendto(packet("ATTITUDE", boot_ms, 0.02, -0.01, 1.0, system=system) +
                         packet("LOCAL_POSITION_NED", boot_ms, 0, 0, -120.0, 10.0, 5.0, 0.0, system=system),
                         ("127.0.0.1", self.port))

    def test_makes_a_step_of_a_picture(self):
        picture = Path(self.folder.name, "1.jpg")
        self.tell(1000)
        time.sleep(0.3)
        self.tell(900, system=8)
        picture.write_bytes(b"\xff\xd8\xff\xd9")
        time.sleep(0.2)
        self.tell(1500)
        step = json.loads(self.program.stdout.readline())
        self.assertEqual(step["image"], str(picture))
        self.assertAlmostEqual(step["time_us"] / 1e6, picture.stat().st_mtime, places=3)
        self.assertAlmostEqual(step["north_m"], 2.0 * step["east_m"], places=2)
        self.assertGreater(step["north_m"], 1.0)
        self.assertAlmostEqual(step["yaw_deg"], math.degrees(1.0), places=2)
        self.assertAlmostEqual(step["roll_deg"], math.degrees(0.02), places=2)
        self.assertAlmostEqual(step["pitch_deg"], math.degrees(-0.01), places=2)
        self.assertEqual(step["agl_m"], 120.0)

    def test_ends_quietly_when_nobody_reads_its_steps(self):
        self.tell(1000)
        self.assertIn("system 7", self.program.stderr.readline())
        self.program.stdout.close()
        Path(self.folder.name, "1.jpg").write_bytes(b"\xff\xd8\xff\xd9")
        time.sleep(0.2)
        self.tell(1400)
        self.assertEqual(self.program.wait(timeout=20), 1)
        self.assertEqual(self.program.stderr.read(), "")

    def test_says_why_a_picture_is_left_out(self):
        Path(self.folder.name, "1.jpg").write_bytes(b"\xff\xd8\xff\xd9")
        self.assertIn("1.jpg is left out: no LOCAL_POSITION_NED of that time", self.program.stderr.readline())


if __name__ == "__main__":
    unittest.main()
