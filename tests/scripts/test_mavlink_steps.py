#!/usr/bin/python3
"""MAVLink to steps: the program with a socket and a folder."""
import importlib.util
import json
import math
import select
import socket
import struct
import subprocess
import sys
import tempfile
import time
import types
import unittest
from pathlib import Path
from unittest import mock

from words import said

PROGRAM = Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"
sys.path.insert(0, str(PROGRAM))

from autopilot import Autopilot  # noqa: E402
from crc import crc  # noqa: E402
from packets import MESSAGES, Message, Stream  # noqa: E402
from receiver import Receiver  # noqa: E402


def packet(name, *values, system=7, component=1):
    number, (_, extra, layout, _) = next((n, m) for n, m in MESSAGES.items() if m[0] == name)
    payload = struct.pack(layout, *values)
    head = bytes([len(payload), 0, 0, 0, system, component]) + number.to_bytes(3, "little")
    return b"\xfd" + head + payload + crc(head + payload + bytes([extra])).to_bytes(2, "little")


def gimbal_status(boot_ms, system=7, component=154):
    """Of one that looks down, the upper edge of its picture 90 degrees clockwise from the nose."""
    return packet("GIMBAL_DEVICE_ATTITUDE_STATUS", boot_ms, 0.5, 0.5, -0.5, 0.5, 0.0, 0.0, 0.0, 0, 44, 0, 0, math.nan,
                  math.nan, 0, system=system, component=component)


class Autopilots(unittest.TestCase):
    def test_are_told_from_gimbals_of_the_same_system(self):
        autopilot = Autopilot(None, 1)
        with said() as words:
            self.assertFalse(autopilot.sent(Message(8, 154, "ATTITUDE", {})))
            self.assertFalse(autopilot.sent(Message(8, 100, "VFR_HUD", {})))
            self.assertFalse(autopilot.sent(Message(0, 1, "ATTITUDE", {})), "no position could be sent to it")
            self.assertTrue(autopilot.sent(Message(7, 1, "ATTITUDE", {})), "the system is that of an autopilot")
            self.assertFalse(autopilot.sent(Message(8, 1, "ATTITUDE", {})))
            for _ in range(3):
                self.assertFalse(autopilot.sent(Message(7, 155, "ATTITUDE", {})))
            self.assertFalse(autopilot.sent(Message(9, 156, "ATTITUDE", {})))
        self.assertEqual(words.getvalue().splitlines(), [
            "component 154 of system 8 sends ATTITUDE too and is ignored (--component)",
            "listening to system 7, component 1",
            "system 8, another vehicle, sends ATTITUDE too and is ignored (--system)",
            "component 155 of system 7 sends ATTITUDE too and is ignored (--component)"])

    def test_have_the_component_and_system_that_are_told(self):
        autopilot = Autopilot(9, 2)
        with said() as words:
            self.assertEqual([autopilot.sent(Message(system, component, "ATTITUDE", {}))
                              for system, component in ((9, 1), (8, 2), (9, 2))], [False, False, True])
        self.assertEqual(words.getvalue().count("\n"), 1, "nobody has to tell which of two vehicles is meant")

    def test_of_several_vehicles_are_told_of_where_nobody_says_which_is_meant(self):
        autopilot = Autopilot(None, 1)
        with said() as words:
            self.assertEqual([autopilot.sent(Message(system, 1, name, {}))
                              for system, name in ((2, "VFR_HUD"), (1, "VFR_HUD"), (1, "ATTITUDE"), (2, "ATTITUDE"),
                                                   (1, "ATTITUDE"), (3, "ATTITUDE"), (0, "ATTITUDE"))],
                             [True, False, False, True, False, False, False])
        self.assertEqual(words.getvalue().splitlines(), [
            "listening to system 2, component 1",
            "system 1, another vehicle, sends ATTITUDE too and is ignored (--system)",
            "system 3, another vehicle, sends ATTITUDE too and is ignored (--system)"])


class Answers(unittest.TestCase):
    def test_to_positions_are_told_where_they_change(self):
        receiver = Receiver(Autopilot(7, 1), None, None)
        with said() as words:
            for system, command, result in ((7, 43003, 4), (7, 43003, 4), (7, 400, 0), (8, 43003, 0), (7, 43003, 0),
                                            (7, 43003, 0), (7, 43003, 3), (7, 43003, 9)):
                receiver.take(Message(system, 1, "COMMAND_ACK", {"command": command, "result": result}), 100.0)
        self.assertEqual(words.getvalue().splitlines(), [
            f"the autopilot takes {what} to MAV_CMD_EXTERNAL_POSITION_ESTIMATE" for what in (
                "no position: it answers FAILED", "positions: it answers ACCEPTED",
                "no position: it answers UNSUPPORTED", "no position: it answers 9")])


class Listening(unittest.TestCase):
    def setUp(self):
        spec = importlib.util.spec_from_file_location("mavlink_steps", PROGRAM / "__main__.py")
        self.program = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.program)
        self.ours, self.theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(self.ours.close)
        self.addCleanup(self.theirs.close)
        self.ours.setblocking(False)

    def test_takes_all_that_came_during_a_long_look_into_a_folder_and_waits_for_nothing(self):
        heard = []
        vehicle = types.SimpleNamespace(hear=lambda name, fields, came: heard.append(fields["time_boot_ms"]))
        for boot_ms in range(50):
            self.theirs.send(packet("ATTITUDE", boot_ms, 0.0, 0.0, 0.0))
        with said():
            self.program.hear(self.ours, Stream(), Receiver(Autopilot(7, 1), vehicle, None))
        self.assertEqual(heard, list(range(50)))

    def test_hears_gimbals_of_whatever_component_of_the_vehicle_alone(self):
        heard = []
        gimbal = types.SimpleNamespace(hear=lambda message, came: heard.append(message.fields["time_boot_ms"]))
        vehicle = types.SimpleNamespace(hear=lambda name, fields, came: self.assertEqual(name, "ATTITUDE"))
        for data in (gimbal_status(1, component=1), packet("ATTITUDE", 2, 0.0, 0.0, 0.0), gimbal_status(3),
                     gimbal_status(4, system=8), gimbal_status(5, component=1)):
            self.theirs.send(data)
        with said():
            self.program.hear(self.ours, Stream(), Receiver(Autopilot(None, 1), vehicle, gimbal))
        self.assertEqual(heard, [3, 5], "before the autopilot was heard nobody knows whose it is")

    def test_looks_at_the_clock_before_the_pictures_and_then_whether_they_come(self):
        class End(Exception):
            pass

        calls = []
        clock = types.SimpleNamespace(look=lambda: calls.append("clock"))
        silence = mock.Mock()
        silence.look.side_effect = End

        def pictures():
            calls.append("pictures")
            return []

        pictures.have_come = False

        options = types.SimpleNamespace(by_air=False, takeoff_agl=0.0, system=None, component=1, camera="body",
                                        delay=0.0, watch="frames", listen=("", 14551))
        self.theirs.send(packet("ATTITUDE", 100, 0.0, 0.0, 0.0))
        began = time.monotonic()
        with mock.patch.object(self.program, "Silence", lambda folder: silence), said(), self.assertRaises(End):
            self.program.follow(self.ours, pictures, None, clock, options)
        self.assertEqual(calls, ["clock", "pictures"])
        (has_picture, heard), _ = silence.look.call_args
        self.assertFalse(has_picture)
        self.assertGreaterEqual(heard, began)


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def start(self, *options):
        self.program = subprocess.Popen(
            [sys.executable, "-B", str(PROGRAM), "--listen", "127.0.0.1:0", "--watch", self.folder.name,
             "--camera", "body", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: [self.program.wait(), self.program.stdout.close(), self.program.stderr.close()])
        self.addCleanup(self.program.terminate)
        self.port = int(self.program.stderr.readline().split()[-1])
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.link.close)

    def tell(self, boot_ms, system=7):
        self.link.sendto(packet("ATTITUDE", boot_ms, 0.02, -0.01, 1.0, system=system) +
                         packet("LOCAL_POSITION_NED", boot_ms, 0, 0, -120.0, 10.0, 5.0, 0.0, system=system) +
                         packet("VFR_HUD", 11.0, 11.0, 640.5, system=system) +
                         packet("GLOBAL_POSITION_INT", boot_ms, 377_581_000, 382_655_000, 0, 120_000, system=system) +
                         packet("GPS_RAW_INT", 0, 377_581_000, 382_655_000, 0, 0, 0, 0, 0, 3, system=system) +
                         packet("ATTITUDE", boot_ms + 50, 1.0, 1.0, 2.0, system=system, component=154) +
                         gimbal_status(boot_ms, system), ("127.0.0.1", self.port))

    def step_of(self, picture):
        """The step that is made of it, half a second after the vehicle began to fly."""
        began = time.monotonic()
        while not select.select([self.program.stdout], [], [], 0.05)[0]:
            flown_s = time.monotonic() - began
            self.tell(1000 + round(1e3 * flown_s))
            self.tell(900, system=8)
            if flown_s > 0.5 and not picture.exists():
                picture.write_bytes(b"\xff\xd8\xff\xd9")
        return json.loads(self.program.stdout.readline())

    def check_time(self, step, picture, delay_s):
        date_s = picture.stat().st_mtime - delay_s
        self.assertAlmostEqual(step["time_us"] / 1e6, date_s, places=3)
        self.assertAlmostEqual(step["monotonic_s"], date_s - (time.time() - time.monotonic()), places=2)

    def test_makes_a_step_of_a_picture(self):
        self.start()
        picture = Path(self.folder.name, "1.jpg")
        step = self.step_of(picture)
        self.assertEqual(step["image"], str(picture))
        self.check_time(step, picture, 0.0)
        self.assertAlmostEqual(step["north_m"], 2.0 * step["east_m"], places=2)
        self.assertGreater(step["north_m"], 1.0)
        self.assertAlmostEqual(step["yaw_deg"], math.degrees(1.0), places=2)
        self.assertAlmostEqual(step["roll_deg"], math.degrees(0.02), places=2)
        self.assertAlmostEqual(step["pitch_deg"], math.degrees(-0.01), places=2)
        self.assertEqual((step["agl_m"], step["alt_m"], step["system"]), (120.0, 640.5, 7))

    def test_tells_which_way_the_camera_of_a_gimbal_looks(self):
        self.start("--camera", "gimbal", "--camera-yaw", "-30", "--camera-pitch", "2", "--camera-roll", "-1.5")
        step = self.step_of(Path(self.folder.name, "1.jpg"))
        self.assertAlmostEqual(step["yaw_deg"], math.degrees(1.0) + 60.0, places=2)
        self.assertEqual((step["roll_deg"], step["pitch_deg"], step["camera_yaw_deg"]), (-1.5, 2.0, 60.0))

    def test_tells_the_time_and_the_height_that_it_was_told(self):
        self.start("--delay", "0.25", "--agl", "90.5")
        picture = Path(self.folder.name, "1.jpg")
        step = self.step_of(picture)
        self.check_time(step, picture, 0.25)
        self.assertEqual(step["agl_m"], 90.5)

    def test_tells_the_height_above_the_sea_alone_where_that_above_ground_is_the_map_s(self):
        self.start("--by-terrain")
        step = self.step_of(Path(self.folder.name, "1.jpg"))
        self.assertEqual(step["alt_m"], 640.5)
        self.assertNotIn("agl_m", step)

    def test_records_a_flight_with_gps_in_a_new_table(self):
        table = Path(self.folder.name, "flight.csv")
        self.start("--camera", "level", "--csv", str(table), "--frame", "focal_px=1000", "principal_px=811,588.5",
                   "distortion=[-0.28, 0.08, 0, 0]", "lens=perspective", "attitude_sigma_deg=0.5")
        step = self.step_of(Path(self.folder.name, "1.jpg"))
        began = time.monotonic()
        while len(table.read_text().splitlines()) < 2 and time.monotonic() < began + 20.0:
            self.tell(5000 + round(1e3 * (time.monotonic() - began)))
            time.sleep(0.05)
        self.program.kill()
        header, row = (line.split(",") for line in table.read_text().splitlines())
        row = dict(zip(header, row))
        self.assertEqual(row.pop("time_s"), f"{1e-6 * step['time_us']:.6f}")
        self.assertEqual(row, {
            "file": "1.jpg", "sequence": "flight", "lat": "37.75810000", "lon": "38.26550000",
            "heading_deg": str(step["yaw_deg"]), "roll_deg": "0.0", "pitch_deg": "0.0", "agl_m": "120.0",
            "focal_px": "1000", "principal_px": "811 588.5", "distortion": "-0.28 0.08 0 0", "lens": "perspective",
            "attitude_sigma_deg": "0.5"})

    def test_records_no_flight_over_another(self):
        table = Path(self.folder.name, "flight.csv")
        table.write_text("another\n")
        ended = subprocess.run([sys.executable, "-B", str(PROGRAM), "--watch", self.folder.name, "--camera", "body",
                                "--listen", "127.0.0.1:0", "--csv", str(table), "--frame", "fov_deg=78"],
                               stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"mavlink_steps: {table} is there already: give each flight a table of its own", ended.stderr)
        self.assertEqual(table.read_text(), "another\n")

    def test_says_where_it_cannot_listen(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("127.0.0.1", 0))
            port = taken.getsockname()[1]
            for address, asks in ((f"127.0.0.1:{port}", True), ("192.0.2.1:0", False)):
                ended = subprocess.run([sys.executable, "-B", str(PROGRAM), "--watch", self.folder.name, "--camera",
                                        "body", "--listen", address], stderr=subprocess.PIPE, text=True, timeout=60)
                self.assertEqual(ended.returncode, 1)
                self.assertIn(f"mavlink_steps: --listen {address}: ", ended.stderr)
                self.assertEqual("does another program" in ended.stderr, asks, ended.stderr)

    def test_outlasts_a_folder_that_is_gone_for_a_moment(self):
        self.start()
        folder = Path(self.folder.name)
        away = folder.with_name(folder.name + ".away")
        folder.rename(away)
        try:
            self.assertIn("no pictures: [Errno 2]", self.program.stderr.readline())
        finally:
            away.rename(folder)
        self.assertIn("can be read again", self.program.stderr.readline())
        self.assertEqual(self.step_of(folder / "1.jpg")["image"], str(folder / "1.jpg"))

    def refusal_of(self, *options):
        ended = subprocess.run([sys.executable, "-B", str(PROGRAM), "--watch", self.folder.name, "--camera", "body",
                                *options], stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(ended.returncode, 2)
        return ended.stderr

    def test_refuses_what_is_no_number_delay_system_or_port(self):
        for option, value in (("--agl", "nan"), ("--takeoff-agl", "inf"), ("--camera-yaw", "x"), ("--delay", "-0.1"),
                              ("--delay", "nan"), ("--system", "0"), ("--system", "256"), ("--listen", "65536"),
                              ("--every", "0"), ("--every", "nan")):
            self.assertIn(f"argument {option}: ", self.refusal_of(option, value))

    def test_refuses_a_camera_that_is_mounted_to_look_at_the_horizon(self):
        for option, value in (("--camera-pitch", "-90"), ("--camera-roll", "80.1"), ("--camera-pitch", "nan")):
            self.assertIn(f"argument {option}: ", self.refusal_of(option, value))
        self.assertIn("straight down, which is 0: the -90 of a gimbal is a pitch of 0",
                      self.refusal_of("--camera-pitch=-90"))
        self.assertIn("--camera-pitch 70 and --camera-roll -60 are together 80.2 degrees from straight down: at most",
                      self.refusal_of("--camera-pitch", "70", "--camera-roll", "-60"))

    def test_refuses_what_no_table_can_tell_of_a_camera(self):
        table = Path(self.folder.name, "a.csv")
        csv = ["--csv", str(table)]
        for options, words in (
                (csv, "--csv needs --frame fov_deg=DEGREES, or --frame focal_px=PIXELS"),
                ([*csv, "--frame", "lens=fisheye"], "--csv needs --frame"),
                ([*csv, "--frame", "fov_deg=78", "focal_px=1000"], "--csv needs --frame"),
                ([*csv, "--frame", "fov_deg=78", "principal_px=811,588"], "--csv needs --frame"),
                (["--frame", "fov_deg=78"], "there is no --csv"),
                (["--csv", "a,b.csv", "--frame", "fov_deg=78"], "'a,b.csv': its name is that of the flight"),
                *(([*csv, "--frame", setting], f"argument --frame: '{setting}': {words}")
                  for setting, words in (
                      ("fov=78", "write NAME=VALUE, the name one of fov_deg, focal_px,"), ("fov_deg", "write a number"),
                      ("fov_deg=wide", "write a number"), ("lens=wide", "write perspective or fisheye"),
                      ("principal_px=811", "it has 1 numbers, not 2"), ("fov_deg=78,60", "it has 2 numbers, not 1")))):
            self.assertIn(words, self.refusal_of(*options))
        self.assertFalse(table.exists())

    def test_ends_quietly_when_nobody_reads_its_steps(self):
        self.start()
        self.tell(1000)
        self.assertIn("system 7", self.program.stderr.readline())
        self.program.stdout.close()
        Path(self.folder.name, "1.jpg").write_bytes(b"\xff\xd8\xff\xd9")
        time.sleep(0.2)
        self.assertIn("component 154", self.program.stderr.readline())
        self.tell(1400)
        self.assertEqual(self.program.wait(timeout=20), 1)
        self.assertEqual(self.program.stderr.read(), "")

    def test_goes_on_where_what_it_says_finds_no_room(self):
        with open("/dev/full", "w") as full:
            program = subprocess.Popen([sys.executable, "-B", str(PROGRAM), "--watch", self.folder.name, "--camera",
                                        "body", "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE, stderr=full)
        self.addCleanup(program.stdout.close)
        with self.assertRaises(subprocess.TimeoutExpired):
            program.wait(timeout=1.0)
        program.kill()
        program.wait()

    def test_says_why_a_picture_is_left_out(self):
        self.start()
        Path(self.folder.name, "1.jpg").write_bytes(b"\xff\xd8\xff\xd9")
        self.assertIn("1.jpg is left out: the autopilot was not heard yet", self.program.stderr.readline())


class LogAndChecksum(unittest.TestCase):
    def test_are_those_of_the_ground_station_too(self):
        for file in ("log.py", "unwaited.py", "crc.py"):
            self.assertEqual((PROGRAM / file).read_text(), (PROGRAM.parent / "ground_station" / file).read_text())


if __name__ == "__main__":
    unittest.main()
