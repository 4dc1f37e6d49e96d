#!/usr/bin/python3
"""Flights that are recorded while the vehicle has GPS."""
import csv
import resource
import sys
import tempfile
import types
import unittest
from pathlib import Path

from fake_time import FakeTime
from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from recording import Recording, columns  # noqa: E402
from table import Table  # noqa: E402
from vehicle import Vehicle  # noqa: E402

NAMES = ["file", "sequence", "time_s", "lat", "lon", "heading_deg", "roll_deg", "pitch_deg"]


class Recordings(unittest.TestCase):
    """Of a flight to the north, by 0.00001 degrees a second from latitude 37 on."""

    def setUp(self):
        self.time = self.enterContext(FakeTime())
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name).resolve()
        self.file = self.folder / "flight 1.csv"
        self.vehicle = Vehicle()
        self.options = types.SimpleNamespace(by_terrain=False, frame={"focal_px": "1000", "principal_px": "811 588"})
        self.began = self.time.now

    def record(self):
        self.table = Table(str(self.file), columns(self.options))
        self.addCleanup(self.table.__exit__)
        self.recording = Recording(self.table, self.vehicle, self.options)

    def fly(self, seconds, fix_type=3):
        """What is said meanwhile."""
        with said() as words:
            for _ in range(round(5 * seconds)):
                self.time.now += 0.2
                flown_s = self.time.now - self.began
                place = {"lat": 370_000_000 + round(100 * flown_s), "lon": 380_000_000}
                self.vehicle.hear("GPS_RAW_INT", {**place, "fix_type": fix_type}, self.time.now)
                self.vehicle.hear("GLOBAL_POSITION_INT", {**place, "time_boot_ms": round(1e3 * self.time.now),
                                                          "relative_alt": 90_000}, self.time.now)
                self.recording.write_due()
        return words.getvalue()

    def take(self, name, pitch_deg=0.25):
        """A picture of now."""
        step = {"time_us": round(1e6 * (self.time.now + self.time.ahead_s)), "image": str(self.folder / name),
                "roll_deg": -1.5, "pitch_deg": pitch_deg, "agl_m": 90.25, "alt_m": 700.5}
        self.recording.add(self.time.now, step, 271.5)

    def rows(self):
        with open(self.file, newline="", encoding="utf-8") as file:
            return list(csv.reader(file))

    def test_tell_of_each_picture_where_it_was_taken_and_by_which_camera(self):
        self.record()
        self.assertEqual(self.rows(), [NAMES + ["agl_m", "focal_px", "principal_px"]])
        self.fly(3.0)
        self.take("1.jpg")
        self.fly(0.5)
        self.take("frames/2.jpg")
        self.take("../elsewhere/3.jpg")
        self.assertEqual(self.fly(2.0) + self.fly(1.1), "")
        rest = ["271.5", "-1.5", "0.25", "90.25", "1000", "811 588"]
        self.assertEqual(self.rows()[1:], [
            ["1.jpg", "flight 1", "1700000103.000000", "37.00003000", "38.00000000", *rest],
            ["frames/2.jpg", "flight 1", "1700000103.400000", "37.00003400", "38.00000000", *rest],
            ["../elsewhere/3.jpg", "flight 1", "1700000103.400000", "37.00003400", "38.00000000", *rest]])

    def test_tell_the_height_above_the_sea_alone_where_the_map_knows_the_ground(self):
        self.options.by_terrain, self.options.frame = True, {"fov_deg": "78"}
        self.record()
        self.fly(3.0)
        self.take("1.jpg")
        self.fly(3.0)
        header, row = self.rows()
        self.assertEqual(header, NAMES + ["alt_m", "fov_deg"])
        self.assertEqual(row[-2:], ["700.5", "78"])

    def test_wait_for_what_gps_tells_after_them(self):
        self.record()
        self.fly(3.0)
        self.take("1.jpg")
        self.fly(2.4)
        self.assertEqual(len(self.rows()), 1)
        self.fly(0.4)
        self.assertEqual(len(self.rows()), 2)

    def test_leave_out_and_say_what_was_taken_without_gps(self):
        self.record()
        self.fly(1.0, fix_type=2)
        words = ""
        for number, fix_type in enumerate((2, 2, 3, 3, 0), 1):
            words += self.fly(2.0, fix_type)
            self.take(f"{number}.jpg")
            words += self.fly(1.0, fix_type)
        words += self.fly(3.0)
        self.assertEqual([row[0] for row in self.rows()[1:]], ["3.jpg", "4.jpg"])
        self.assertEqual(words.splitlines(), [
            f"{self.folder}/1.jpg: not in {self.file}, nor are those after it: the GPS had no 3D fix",
            f"{self.folder}/3.jpg: in {self.file} again, as are those after it",
            f"{self.folder}/5.jpg: not in {self.file}, nor are those after it: the GPS had no 3D fix"])

    def test_leave_out_what_no_table_can_name_and_what_looks_at_the_horizon(self):
        self.record()
        self.fly(3.0)
        for name, pitch_deg, why in (("a,b.jpg", 0.0, "commas, quotes, line breaks"), ('"a".jpg', 0.0, "commas"),
                                     ("a\nb.jpg", 0.0, "commas"), ("5.jpg", 81.0, "looked at the horizon")):
            self.take(name, pitch_deg)
            self.assertIn(why, self.fly(3.0))
            self.take(f"{len(self.rows())}.jpg", 79.0)
            self.assertIn("again", self.fly(3.0))
        self.assertEqual([row[0] for row in self.rows()[1:]], ["1.jpg", "2.jpg", "3.jpg", "4.jpg"])

    def test_say_which_rows_name_pictures_that_others_were_written_over(self):
        self.record()
        self.fly(3.0)
        words = ""
        for name in ("1.jpg", "2.jpg", "1.jpg"):
            self.take(name)
            words += self.fly(3.0)
        self.assertEqual([row[0] for row in self.rows()[1:]], ["1.jpg", "2.jpg"])
        self.assertEqual(words, f"{self.folder}/1.jpg: not in {self.file}, nor are those after it: its name is that of "
                                "a picture that is in the table and was written over: remove that row, and give each "
                                "picture a name of its own\n")

    def test_find_pictures_through_links_to_their_folders(self):
        for name in ("disk/frames", "disk/tables"):
            (self.folder / name).mkdir(parents=True)
        (self.folder / "tables").symlink_to(self.folder / "disk" / "tables")
        (self.folder / "frames").symlink_to(self.folder / "disk" / "frames")
        self.file = self.folder / "tables" / "flight.csv"
        self.record()
        self.fly(3.0)
        self.take("disk/frames/1.jpg")
        self.take("frames/2.jpg")
        self.fly(3.0)
        self.assertEqual([row[0] for row in self.rows()[1:]], ["../frames/1.jpg", "../frames/2.jpg"],
                         "from where the table is")

    def test_hold_whole_rows_where_the_disk_is_full_and_go_on_where_it_is_not_any_more(self):
        self.record()
        self.fly(3.0)
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        self.addCleanup(resource.setrlimit, resource.RLIMIT_FSIZE, limits)
        words = ""
        for number, room in enumerate((200, 200, None), 1):
            resource.setrlimit(resource.RLIMIT_FSIZE, (room or limits[0], limits[1]))
            self.take(f"{number}.jpg")
            words += self.fly(3.0)
            self.assertTrue(self.file.read_text().endswith("\n"))
        self.assertEqual([row[0] for row in self.rows()], ["file", "1.jpg", "3.jpg"])
        self.assertEqual(words.splitlines(), [
            f"{self.folder}/2.jpg: not in {self.file}, nor are those after it: the disk has no room for the table",
            f"{self.folder}/3.jpg: in {self.file} again, as are those after it"])


class Tables(unittest.TestCase):
    def test_are_new_files(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "flight.csv")
            file.write_text("file\n")
            with self.assertRaisesRegex(OSError, "flight.csv is there already: give each flight a table of its own"):
                Table(str(file), ["file"])
            self.assertEqual(file.read_text(), "file\n")


if __name__ == "__main__":
    unittest.main()
