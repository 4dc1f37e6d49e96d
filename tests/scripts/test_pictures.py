#!/usr/bin/python3
"""Pictures to steps: files, a clock that is set while they come, and lines of what the autopilot told of their time."""
import contextlib
import io
import json
import math
import os
import sys
import tempfile
import time
import types
import unittest
from pathlib import Path
from unittest import mock

from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from clock import WallClock  # noqa: E402
from gimbal import STATUS, Gimbal  # noqa: E402
from lines import Lines  # noqa: E402
from packets import Message  # noqa: E402
from pictures import NewPictures, Silence  # noqa: E402
from vehicle import Vehicle  # noqa: E402


FRACTION_S = 0.25  # of a second, in dates of files


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
            pauses = []

            def date():
                fake.now += pauses.pop() if pauses else 0.0
                return fake.now + fake.ahead_s

            with mock.patch("time.time", date):
                pauses.append(5.0)
                clock = WallClock()
                self.assertAlmostEqual(clock.ahead_s, fake.ahead_s, places=6)
                pauses.append(5.0)
                clock.look()
            self.assertEqual(words.getvalue(), "")
            self.assertAlmostEqual(clock.ahead_s, fake.ahead_s, places=6)


class Pictures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name, "frames")
        self.folder.mkdir()
        self.clock = types.SimpleNamespace(monotonic=lambda date_s: date_s - FRACTION_S - 1000, was_set=False)
        self.time = FakeTime()
        self.time.__enter__()
        self.addCleanup(self.time.__exit__)

    def write(self, name, content=b"\xff\xd8\xff\xd9", date_s=None):
        path = Path(self.folder, name)
        path.write_bytes(content)
        if date_s is not None:
            os.utime(path, (date_s + FRACTION_S,) * 2)

    def new(self, pictures):
        """Names, and what was said."""
        with said() as words:
            return [path.name for path, _ in pictures()], words.getvalue()

    def test_are_taken_once_they_are_whole_in_the_order_they_were_written(self):
        self.write("old.jpg")
        new = NewPictures(self.folder, self.clock)
        self.write("b.JPG", date_s=50)
        self.write("a.png", b"\x89PNG IEND\xaeB`\x82", date_s=60)
        for number in range(9):
            self.write(f"{number}.jpeg", date_s=59 - number)
        self.write("half.jpg", b"\xff\xd8\xff", date_s=1099.5)
        self.write("notes.txt")
        taken = new()
        self.assertEqual([written for _, written in taken], list(range(-950, -939)))
        self.assertEqual([taken[at][0].name for at in (1, 9, 10)], ["8.jpeg", "0.jpeg", "a.png"])
        self.assertEqual(new(), [])
        self.write("half.jpg")
        self.assertEqual(self.new(new), (["half.jpg"], ""))
        self.write("odd.jpg", b"\xff\xd8 and no end", date_s=70)
        self.assertEqual(self.new(new), (["odd.jpg"], ""), "nothing was written for long")
        self.write("empty.jpg", b"", date_s=70)
        self.assertEqual(self.new(new)[0], [], "there is nothing in it yet")

    def test_are_taken_again_where_a_camera_begins_anew_with_the_names_that_it_gave_before(self):
        for number in range(1, 4):
            self.write(f"{number}.jpg", date_s=50)
        new = NewPictures(self.folder, self.clock)
        self.assertEqual(self.new(new), ([], ""))
        self.write("3.jpg", b"\xff\xd8 of the next flight \xff\xd9", date_s=50)
        self.assertEqual(self.new(new), (["3.jpg"], ""), "of a file system that knows no better date")
        for begin_s in (58, 158):
            for number in range(1, 6):
                self.write(f"{number}.jpg", date_s=begin_s + number)
                self.assertEqual(self.new(new), ([f"{number}.jpg"], ""))
                self.assertEqual(self.new(new), ([], ""))

    def test_are_not_told_of_a_file_in_which_the_reader_may_find_the_next_one(self):
        new = NewPictures(self.folder, self.clock)
        self.write("latest.jpg", date_s=100)
        self.assertEqual(self.new(new), (["latest.jpg"], ""))
        for date_s in (100.5, 110.4):  # after 0.5 and 9.9 s
            self.write("latest.jpg", date_s=date_s)
            names, words = self.new(new)
            self.assertEqual(names, [])
            self.assertIn("give each a name of its own", words)
        self.write("latest.jpg", date_s=120.5)
        self.assertEqual(self.new(new), (["latest.jpg"], ""), "10.1 s later")

    def test_are_left_out_where_their_dates_are_in_whole_seconds_which_a_vehicle_flies_far_in(self):
        new = NewPictures(self.folder, self.clock)
        for date_s, is_taken in ((50, False), (52, False), (52.001, True), (54, False)):
            self.write(f"{date_s}.jpg", date_s=date_s - FRACTION_S)
            names, words = self.new(new)
            self.assertEqual(names, [f"{date_s}.jpg"] if is_taken else [])
            self.assertEqual("is left out: its date is one in whole seconds" in words, not is_taken)
            self.assertEqual(self.new(new), ([], ""), "it is said once")

    def test_in_a_full_folder_are_found_by_their_names_and_those_taken_are_looked_at_by_and_by(self):
        new = NewPictures(self.folder, self.clock)
        for number in range(120):
            self.write(f"{number:03}.jpg", date_s=50)
            self.write(f"{number:03}.txt")
        self.assertEqual(len(new()), 120)
        self.write("later.jpg", date_s=60)
        for number in (10, 60, 110):
            self.write(f"{number:03}.jpg", date_s=70)
        with mock.patch("pictures.LOOKS", 50), mock.patch("os.stat", wraps=os.stat) as looks:
            for names in (["010.jpg", "later.jpg"], ["060.jpg"], ["110.jpg"], []):
                looks.reset_mock()
                with mock.patch("os.path.splitext", wraps=os.path.splitext) as readings:
                    self.assertEqual(sorted(self.new(new)[0]), names)
                self.assertLessEqual(looks.call_count, 50)
                self.assertLess(readings.call_count, 10)

    def test_that_were_seen_before_the_clock_was_set_have_the_time_of_the_clock_before(self):
        fake = self.time
        with said() as words:
            clock = WallClock()
            new = NewPictures(self.folder, clock)
            self.write("odd.jpg", b"no end", date_s=fake.now + fake.ahead_s)
            self.assertEqual(new(), [])
            fake.ahead_s -= 60.0
            self.write("between.jpg", date_s=fake.now + fake.ahead_s)
            fake.now += 2.0
            clock.look()
            self.assertEqual([(path.name, written) for path, written in new()], [("odd.jpg", 100.0 + FRACTION_S)])
            self.assertIn("between.jpg is left out: the clock was set while it was written", words.getvalue())
            clock.look()
            self.write("later.jpg", date_s=fake.now + fake.ahead_s)
            self.assertEqual([(path.name, written) for path, written in new()], [("later.jpg", 102.0 + FRACTION_S)])

    def test_are_waited_for_while_their_folder_cannot_be_read(self):
        self.write("1.jpg", date_s=50)
        new = NewPictures(self.folder, self.clock)
        away = self.folder.with_name("away")
        self.folder.rename(away)
        names, words = self.new(new)
        self.assertEqual(names, [])
        self.assertIn("no pictures: [Errno 2] No such file or directory", words)
        self.assertEqual(self.new(new), ([], ""), "it is said once")
        away.rename(self.folder)
        self.write("2.jpg", date_s=60)
        self.assertEqual(self.new(new), (["2.jpg"], f"{self.folder} can be read again\n"))

    def test_that_do_not_come_while_the_autopilot_speaks_are_missed(self):
        silence = Silence(self.folder)
        for pause_s, has_picture, unheard_s, expected in (
                (9.9, False, 0.0, ""), (0.2, False, 10.1, ""), (0.0, False, 9.9, "no picture has come for 10 s"),
                (5.0, False, 0.0, ""), (1.0, True, 0.0, "pictures come again"), (9.9, False, 0.0, ""),
                (0.0, True, 0.0, ""), (9.9, False, 0.0, ""), (0.2, False, 0.0, "no picture has come for 10 s")):
            self.time.now += pause_s
            with said() as words:
                silence.look(has_picture, self.time.now - unheard_s)
            self.assertEqual(words.getvalue()[:len(expected) or None], expected)

    def test_that_go_on_in_another_folder_are_looked_for_there(self):
        begin_s = time.time()
        for name, date_s in (("100MEDIA", begin_s - 60.0), ("101MEDIA", begin_s + 5.0), ("102MEDIA", begin_s - 1.0)):
            Path(self.folder, name).mkdir()
            os.utime(Path(self.folder, name), (date_s, date_s))
        silence = Silence(self.folder)
        self.time.now += 10.1
        with said() as words:
            silence.look(False, self.time.now)
        self.assertIn(f"does the camera go on in {self.folder}/101MEDIA?", words.getvalue())
        with said() as words:
            silence.look(True, self.time.now)
            self.time.now += 10.1
            silence.look(False, self.time.now)
        self.assertIn("does the camera write into the folder?", words.getvalue())

    def test_that_stay_empty_are_told_of_once(self):
        new = NewPictures(self.folder, self.clock)
        self.write("1.jpg", b"", date_s=self.time.now + 1000)
        self.assertEqual(self.new(new), ([], ""))
        self.time.now += 10.5
        self.assertEqual(self.new(new), ([], f"{self.folder}/1.jpg is empty\n"))
        self.assertEqual(self.new(new), ([], ""))
        self.write("1.jpg")
        self.assertEqual(self.new(new)[0], ["1.jpg"])


class LinesOfPictures(unittest.TestCase):
    """Of a flight to the north at 10 m/s."""

    def setUp(self):
        self.time = FakeTime()
        self.time.__enter__()
        self.addCleanup(self.time.__exit__)
        self.vehicle = Vehicle()
        self.clock = WallClock()
        self.options = types.SimpleNamespace(camera="level", camera_yaw=0.0, agl=100.0, delay=0.0, origin="o")
        self.lines = self.lines_of(None)

    def lines_of(self, gimbal):
        return Lines(self.vehicle, gimbal, types.SimpleNamespace(system=7), self.clock, self.options)

    def fly(self, seconds, heard=True, roll=0.0, yaw=0.0, height_m=9.0, moved=True):
        for _ in range(round(10 * seconds)):
            self.time.now += 0.1
            if heard:
                boot_ms = round(1e3 * self.time.now)
                self.vehicle.hear("ATTITUDE", {"time_boot_ms": boot_ms, "roll": roll, "pitch": 0.1, "yaw": yaw},
                                  self.time.now)
                if moved:
                    fields = {"time_boot_ms": boot_ms, "z": -height_m, "vx": 10, "vy": 0}
                    self.vehicle.hear("LOCAL_POSITION_NED", fields, self.time.now)

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

    def test_have_no_place_where_the_autopilot_tells_no_velocity(self):
        steps, words = [], ""
        for moved, seconds in ((False, 3.0), (False, 1.0), (True, 3.0), (True, 1.0), (False, 4.0)):
            self.fly(seconds, moved=moved)
            self.lines.add(f"{len(steps)}.jpg", self.time.now - 0.05)
            (step,), said_now = self.printed()
            steps.append(step)
            words += said_now
        self.assertEqual(["north_m" in step for step in steps], [False, False, True, True, False])
        for step in steps:
            self.assertEqual("east_m" in step and "yaw_deg" in step, "north_m" in step)
            self.assertEqual((step["roll_deg"], step["camera_yaw_deg"], step["origin"]), (0.0, 0.0, "o-0"))
        self.assertEqual(words.splitlines(), [
            "0.jpg: no LOCAL_POSITION_NED of that time: its movement is not known",
            "2.jpg: movements are known again from here",
            "4.jpg: no LOCAL_POSITION_NED of that time: its movement is not known"])

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

    def test_of_a_gimbal_are_left_out_where_it_says_nothing_and_wait_for_what_it_says_later(self):
        self.options.camera, gimbal = "gimbal", Gimbal(154)
        self.lines = self.lines_of(gimbal)

        def tell(yaw_deg):
            """Pitch -90, in the vehicle's frame."""
            c, s = (math.sqrt(0.5) * part(math.radians(0.5 * yaw_deg)) for part in (math.cos, math.sin))
            fields = {"time_boot_ms": round(1e3 * self.time.now), "flags": 44, "qw": c, "qx": s, "qy": -c, "qz": s,
                      "delta_yaw": math.nan, "gimbal_device_id": 0}
            gimbal.hear(Message(7, 154, STATUS, fields), self.time.now)

        self.fly(3.0, roll=0.2, yaw=1.0)
        self.lines.add("1.jpg", self.time.now - 0.55)
        self.assertEqual(self.printed(), ([], "1.jpg is left out: no two GIMBAL_DEVICE_ATTITUDE_STATUS around that "
                                              "time, at most 0.6 s apart\n"))
        tell(20.0)
        self.fly(0.2, roll=0.2, yaw=1.0)
        self.lines.add("2.jpg", self.time.now - 0.1)
        self.assertEqual(self.printed(), ([], ""))
        tell(40.0)
        ((step,), _) = self.printed()
        self.assertAlmostEqual(step["yaw_deg"], math.degrees(1.0) + 30.0, places=2)
        self.assertEqual((step["roll_deg"], step["pitch_deg"], step["camera_yaw_deg"]), (0.0, 0.0, 30.0))

    def test_are_not_kept_back_by_a_picture_of_the_future(self):
        self.fly(3.0)
        for ahead_s in (3600.0, 0.51):
            with said() as words:
                self.lines.add("future.jpg", self.time.now + ahead_s)
            self.assertIn(f"future.jpg is left out: its time lies {ahead_s:.1f} s ahead", words.getvalue())
        with said() as words:
            self.lines.add("0.jpg", self.time.now + 0.49)
        self.assertEqual(words.getvalue(), "")
        self.fly(1.0)
        self.assertEqual([step["image"] for step in self.printed()[0]], ["0.jpg"])
        self.lines.add("1.jpg", self.time.now - 0.05)
        self.assertEqual([step["image"] for step in self.printed()[0]], ["1.jpg"])

    def test_tell_when_they_were_taken_by_the_monotonic_clock_too(self):
        self.fly(3.0)
        self.time.ahead_s += 3600.0
        with said():
            self.clock.look()
        captured = self.time.now - 0.05
        self.lines.add("1.jpg", captured)
        ((step,), _) = self.printed()
        self.assertAlmostEqual(step["monotonic_s"], captured, places=5)
        self.assertAlmostEqual(1e-6 * step["time_us"], captured + 1_700_000_000.0, places=3)

    def test_wait_for_what_the_autopilot_tells_of_the_time_after_them(self):
        self.fly(3.0)
        self.lines.add("1.jpg", self.time.now + 0.01)
        self.assertEqual(self.printed(), ([], ""))
        self.fly(0.1)
        self.assertEqual(len(self.printed()[0]), 1)

    def test_wait_no_longer_than_half_a_second_for_it(self):
        for delay_s in (0.0, 2.0):
            self.options.delay = delay_s
            self.fly(3.0)
            self.lines.add("1.jpg", self.time.now + 0.01)
            self.time.now += delay_s + 0.5
            self.assertEqual(self.printed(), ([], ""))
            self.time.now += 0.02
            steps, words = self.printed()
            self.assertEqual(steps, [])
            self.assertIn("1.jpg is left out: no ", words)

    def test_are_taken_above_ground(self):
        for told_m, height_m in ((100.0, 100.0), (0.01, 0.01), (0.004, None), (0.0, None), (-3.0, None), (None, 9.0)):
            self.options.agl = told_m
            self.fly(1.0)
            self.lines.add("1.jpg", self.time.now - 0.05)
            steps, words = self.printed()
            self.assertEqual([step["agl_m"] for step in steps], [] if height_m is None else [height_m])
            self.assertEqual("above ground" in words, height_m is None)
        self.fly(1.0, height_m=-0.5)
        self.lines.add("1.jpg", self.time.now - 0.05)
        self.assertEqual(self.printed(), ([], "1.jpg is left out: it was taken -0.5 m above ground\n"))

    def test_name_the_vehicle_to_which_positions_go(self):
        self.fly(3.0)
        self.lines.add("1.jpg", self.time.now - 0.05)
        self.assertEqual(self.printed()[0][0]["system"], 7)

    def test_never_go_back_in_time(self):
        self.fly(3.0)
        for path, ago_s in (("1.jpg", 1.0), ("2.jpg", 1.5), ("3.jpg", 1.0), ("4.jpg", 0.5)):
            self.lines.add(path, self.time.now - ago_s)
        steps, words = self.printed()
        self.assertEqual([step["image"] for step in steps], ["1.jpg", "4.jpg"])
        self.assertEqual(words.count("not taken after the one before it"), 2)


if __name__ == "__main__":
    unittest.main()
