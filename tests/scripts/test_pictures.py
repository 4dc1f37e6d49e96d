#!/usr/bin/python3
"""Pictures to steps: files, a clock that is set while they come, and lines of what the autopilot told of their time."""
import contextlib
import io
import json
import math
import os
import sys
import tempfile
import types
import unittest
from pathlib import Path
from unittest import mock

from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from clock import WallClock  # noqa: E402
from lines import Lines  # noqa: E402
from pictures import NewPictures  # noqa: E402
from vehicle import Vehicle  # noqa: E402


class FakeTime:
    """time.monotonic() and the clock, which may be set."""

    def __init__(self):
        self.now, self.ahead_s = 100.0, 1_700_000_000.0

    def __enter__(self):
        self._patches = [mock.patch("time.monotonic", lambda: self.now),
                         mock.patch("time.time", lambda: self.now + self.ahead_s)]
        for patch in self._patches:
            patch.start()
        return self

    def __exit__(self, *_):
        for patch in self._patches:
            patch.stop()


class Clocks(unittest.TestCase):
    def test_that_are_set_move_no_time_and_say_so(self):
        with FakeTime() as fake:
            clock = WallClock()
            for step_s, words in ((60.0, "set by +60.0 s"), (-1.5, "set by -1.5 s"), (0.1, "")):
                fake.ahead_s += step_s
                fake.now += 0.1
                with said() as text:
                    clock.look()
                self.assertIn(words, text.getvalue())
                self.assertEqual(bool(text.getvalue()), bool(words))
                self.assertAlmostEqual(clock.monotonic(fake.now + fake.ahead_s), fake.now, places=6)

    def test_that_are_set_in_flight_do_not_move_the_times_that_are_told(self):
        for step_s in (-3600.0, -0.01, 0.3, 2e8):
            with FakeTime() as fake, said():
                clock = WallClock()
                before_us = clock.date_us(fake.now)
                self.assertEqual(before_us, 1_700_000_100_000_000)
                fake.ahead_s += step_s
                fake.now += 2.0
                clock.look()
                self.assertEqual(clock.date_us(fake.now) - before_us, 2_000_000, step_s)

    def test_are_set_only_where_they_jump(self):
        for step_s, is_set in ((0.19, False), (-0.19, False), (0.21, True), (-0.21, True)):
            with FakeTime() as fake, said() as words:
                clock = WallClock()
                fake.ahead_s += step_s
                clock.look()
                self.assertEqual((clock.was_set, bool(words.getvalue())), (is_set, is_set), step_s)
                clock.look()
                self.assertFalse(clock.was_set)

    def test_are_not_set_by_a_pause_of_this_process_between_two_readings(self):
        with FakeTime() as fake, said() as words:
            clock = WallClock()
            pauses = iter((0.0, 5.0))

            def date():
                fake.now += next(pauses, 0.0)
                return fake.now + fake.ahead_s

            with mock.patch("time.time", date):
                clock.look()
            self.assertEqual(words.getvalue(), "")
            self.assertAlmostEqual(clock.ahead_s, fake.ahead_s, places=6)


class Pictures(unittest.TestCase):
    def test_are_taken_once_they_are_whole_in_the_order_they_were_written(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "old.jpg").write_bytes(b"\xff\xd8\xff\xd9")
            new = NewPictures(folder, types.SimpleNamespace(monotonic=lambda date_s: date_s - 1000))
            Path(folder, "b.JPG").write_bytes(b"\xff\xd8\xff\xd9")
            Path(folder, "a.png").write_bytes(b"\x89PNG IEND\xaeB`\x82")
            Path(folder, "half.jpg").write_bytes(b"\xff\xd8\xff")
            Path(folder, "notes.txt").write_bytes(b"\xff\xd9")
            os.utime(Path(folder, "b.JPG"), (50, 50))
            os.utime(Path(folder, "a.png"), (60, 60))
            self.assertEqual([(path.name, written) for path, written in new()], [("b.JPG", -950), ("a.png", -940)])
            self.assertEqual(new(), [])
            with open(Path(folder, "half.jpg"), "ab") as rest:
                rest.write(b"\xd9")
            self.assertEqual([path.name for path, _ in new()], ["half.jpg"])
            Path(folder, "odd.jpg").write_bytes(b"\xff\xd8 and no end")
            os.utime(Path(folder, "odd.jpg"), (70, 70))
            self.assertEqual([path.name for path, _ in new()], ["odd.jpg"], "nothing was written for long")

    def test_are_found_in_a_full_folder_by_names_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            new = NewPictures(folder, types.SimpleNamespace(monotonic=lambda date_s: date_s))
            for i in range(1000):
                Path(folder, f"{i:04}.jpg").write_bytes(b"\xff\xd9")
                Path(folder, f"{i:04}.txt").touch()
            self.assertEqual(len(new()), 1000)
            Path(folder, "later.jpg").write_bytes(b"\xff\xd9")
            with mock.patch("pathlib.PurePath.suffix", new_callable=mock.PropertyMock, return_value=".jpg") as looks:
                self.assertEqual([path.name for path, _ in new()], ["later.jpg"])
            self.assertLess(looks.call_count, 10)

    def test_that_were_seen_before_the_clock_was_set_have_the_time_of_the_clock_before(self):
        with tempfile.TemporaryDirectory() as folder, FakeTime() as fake, said():
            clock = WallClock()
            new = NewPictures(folder, clock)
            odd = Path(folder, "odd.jpg")
            odd.write_bytes(b"no end")
            os.utime(odd, (fake.now + fake.ahead_s,) * 2)
            self.assertEqual(new(), [])
            fake.ahead_s -= 60.0
            fake.now += 2.0
            clock.look()
            later = Path(folder, "later.jpg")
            later.write_bytes(b"\xff\xd9")
            os.utime(later, (fake.now + fake.ahead_s,) * 2)
            seen = new()
            self.assertEqual([path.name for path, _ in seen], ["odd.jpg", "later.jpg"])
            self.assertAlmostEqual(seen[0][1], 100.0, places=3)
            self.assertAlmostEqual(seen[1][1], 102.0, places=3)


class LinesOfPictures(unittest.TestCase):
    """Of a flight to the north at 10 m/s."""

    def setUp(self):
        self.time = FakeTime()
        self.time.__enter__()
        self.addCleanup(self.time.__exit__)
        self.vehicle = Vehicle()
        self.clock = WallClock()
        self.options = types.SimpleNamespace(camera="level", camera_yaw=0.0, agl=100.0, delay=0.0, origin="o")
        self.lines = Lines(self.vehicle, self.clock, self.options)

    def fly(self, seconds, heard=True, roll=0.0, yaw=0.0):
        for _ in range(round(10 * seconds)):
            self.time.now += 0.1
            if heard:
                boot_ms = round(1e3 * self.time.now)
                self.vehicle.hear("ATTITUDE", {"time_boot_ms": boot_ms, "roll": roll, "pitch": 0.1, "yaw": yaw},
                                  self.time.now)
                self.vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": boot_ms, "z": -9, "vx": 10, "vy": 0},
                                  self.time.now)

    def printed(self):
        """Steps and words."""
        with contextlib.redirect_stdout(io.StringIO()) as lines, said() as words:
            self.lines.print_due()
        return [json.loads(line) for line in lines.getvalue().splitlines()], words.getvalue()

    def test_have_another_origin_after_a_hole_in_what_the_autopilot_tells(self):
        self.fly(3.0)
        self.lines.add("1.jpg", self.time.now - 0.55)
        late = self.time.now - 0.25
        (first,), _ = self.printed()
        self.fly(10.0, heard=False)
        self.fly(3.0)
        self.lines.add("2.jpg", late)
        self.lines.add("3.jpg", self.time.now - 2.05)
        self.lines.add("4.jpg", self.time.now - 0.05)
        (second, third, fourth), words = self.printed()
        self.assertEqual(second["origin"], first["origin"], "a picture from before the hole that came after it")
        self.assertAlmostEqual(second["north_m"] - first["north_m"], 3.0, places=2)
        self.assertNotEqual(third["origin"], second["origin"])
        self.assertEqual(fourth["origin"], third["origin"])
        self.assertAlmostEqual(fourth["north_m"] - third["north_m"], 20.0, places=2)
        self.assertEqual(words, "3.jpg: no velocity for more than 2 s before it: the movement is not known\n")

    def test_are_the_same_while_the_clock_is_set(self):
        self.fly(3.0)
        steps = []
        for step_s in (0.0, 60.0, -3600.0, 1.5):
            self.time.ahead_s += step_s
            with said():
                self.clock.look()
            self.fly(2.0)
            self.lines.add("1.jpg", self.clock.monotonic(self.time.now + self.time.ahead_s - 0.05))
            steps += self.printed()[0]
        self.assertEqual(len(steps), 4)
        self.assertNotIn("alt_m", steps[0], "the autopilot told no height above the sea")
        for before, now in zip(steps, steps[1:]):
            self.assertAlmostEqual(now["north_m"] - before["north_m"], 20.0, places=2)
            self.assertGreater(now["time_us"], before["time_us"])
            self.assertEqual(now["origin"], before["origin"])

    def test_tell_the_heading_of_the_vehicle_from_that_of_its_camera(self):
        for camera, camera_yaw in (("level", 0.0), ("level", 90.0), ("body", 0.0), ("body", -90.0), ("body", 200.0)):
            self.options.camera, self.options.camera_yaw = camera, camera_yaw
            self.fly(3.0, roll=0.2, yaw=3.0)
            self.lines.add("1.jpg", self.time.now - 0.05)
            ((step,), _) = self.printed()
            vehicle_deg = step["yaw_deg"] - step["camera_yaw_deg"]
            self.assertAlmostEqual(math.remainder(vehicle_deg - math.degrees(3.0), 360.0), 0.0, places=2)
            self.assertAlmostEqual(math.remainder(step["camera_yaw_deg"] - camera_yaw, 360.0), 0.0,
                                   delta=0.01 if camera == "level" else 3.0)

    def test_are_not_kept_back_by_a_picture_of_the_future(self):
        self.fly(3.0)
        with said() as words:
            self.lines.add("future.jpg", self.time.now + 3600.0)
        self.assertIn("future.jpg is left out: its time lies 3600.0 s ahead", words.getvalue())
        self.lines.add("1.jpg", self.time.now - 0.05)
        self.assertEqual([step["image"] for step in self.printed()[0]], ["1.jpg"])

    def test_never_go_back_in_time(self):
        self.fly(3.0)
        for path, ago_s in (("1.jpg", 1.0), ("2.jpg", 1.5), ("3.jpg", 1.0), ("4.jpg", 0.5)):
            self.lines.add(path, self.time.now - ago_s)
        steps, words = self.printed()
        self.assertEqual([step["image"] for step in steps], ["1.jpg", "4.jpg"])
        self.assertEqual(words.count("not taken after the one before it"), 2)


if __name__ == "__main__":
    unittest.main()
