#!/usr/bin/python3
"""Files of pictures, and a clock that is set while they come."""
import os
import sys
import tempfile
import time
import types
import unittest
from pathlib import Path
from unittest import mock

from fake_time import FakeTime
from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from clock import WallClock  # noqa: E402
from pictures import NewPictures, Silence  # noqa: E402


FRACTION_S = 0.25  # of a second, in dates of files


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
            self.assertIn("give each picture a name of its own", words)
        self.write("latest.jpg", date_s=120.5)
        self.assertEqual(self.new(new), (["latest.jpg"], ""), "10.1 s later")

    def test_that_come_with_a_pause_are_said_to(self):
        new = NewPictures(self.folder, self.clock)
        self.write("1.jpg", b"\xff\xd8 half", date_s=100)
        self.time.now = 101.1
        self.assertEqual(self.new(new), (["1.jpg"], ""), "it might have another ending, as some cameras'")
        self.write("1.jpg", b"\xff\xd8 half and whole \xff\xd9", date_s=101.6)
        names, words = self.new(new)
        self.assertEqual(names, [])
        self.assertIn("1.jpg is left out: it was taken as it was 1.6 s before: ", words)
        self.assertIn("write it without a pause", words)

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

    def test_of_a_kind_that_is_not_read_are_named_where_no_others_come(self):
        begin_s = time.time()
        for name, seconds in (("old.tif", -1.0), ("1.tif", 4.0), ("2.TIF", 5.0), ("0.jpg", 6.0), ("flight.csv", 7.0)):
            self.write(name)
            os.utime(self.folder / name, (begin_s + seconds,) * 2)
        self.check_question(begin_s, f"only .jpg, .jpeg, .png are read, and {self.folder}/2.TIF is something else")
        Path(self.folder, "101MEDIA").mkdir()
        os.utime(Path(self.folder, "101MEDIA"), (begin_s + 1.0,) * 2)
        self.check_question(begin_s, f"does the camera go on in {self.folder}/101MEDIA?")

    def check_question(self, begin_s, question):
        """Where no picture came since."""
        self.time.now = begin_s - self.time.ahead_s
        silence = Silence(self.folder)
        self.time.now += 10.1
        with said() as words:
            silence.look(False, self.time.now)
        self.assertTrue(words.getvalue().endswith(f": {question}\n"), words.getvalue())

    def test_that_stay_empty_are_told_of_once(self):
        new = NewPictures(self.folder, self.clock)
        self.write("1.jpg", b"", date_s=self.time.now + 1000)
        self.assertEqual(self.new(new), ([], ""))
        self.time.now += 10.5
        self.assertEqual(self.new(new), ([], f"{self.folder}/1.jpg is empty\n"))
        self.assertEqual(self.new(new), ([], ""))
        self.write("1.jpg")
        self.assertEqual(self.new(new)[0], ["1.jpg"])


if __name__ == "__main__":
    unittest.main()
