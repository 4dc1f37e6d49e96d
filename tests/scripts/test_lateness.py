#!/usr/bin/python3
"""Pictures that come later and later, told by their EXIF or by their numbers."""
import datetime
import os
import random
import struct
import sys
import tempfile
import types
import unittest
from pathlib import Path

from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

import exif  # noqa: E402
from lateness import Lateness  # noqa: E402
from pictures import NewPictures  # noqa: E402

NOON_S = datetime.datetime(2026, 5, 1, 12, tzinfo=datetime.timezone.utc).timestamp()
JFIF = b"\xff\xe0\x00\x10JFIF\0\x01\x01\0\0\x01\0\x01\0\0"
XMP = b"\xff\xe1\x00\x1fhttp://ns.adobe.com/xap/1.0/\0"


def directory(order, at, entries):
    """Texts and offsets of a TIFF directory that begins at `at`."""
    head, behind = struct.pack(order + "H", len(entries)), b""
    for tag, value in entries:
        if isinstance(value, int):
            head += struct.pack(order + "HHII", tag, 4, 1, value)
            continue
        text = value.encode() + b"\0"
        if len(text) <= 4:
            head += struct.pack(order + "HHI4s", tag, 2, len(text), text)
        else:
            head += struct.pack(order + "HHII", tag, 2, len(text), at + 6 + 12 * len(entries) + len(behind))
            behind += text
    return head + bytes(4) + behind


def jpeg(date, fraction=None, order="<", before=JFIF):
    texts = [(exif.DATE, date)] + ([(exif.FRACTION, fraction)] if fraction is not None else [])
    tiff = (b"II*\0" if order == "<" else b"MM\0*") + struct.pack(order + "I", 8)
    tiff += directory(order, 8, [(exif.EXIF_IFD, 26)]) + directory(order, 26, texts)
    segment = b"Exif\0\0" + tiff
    return (b"\xff\xd8" + before + b"\xff\xe1" + struct.pack(">H", len(segment) + 2) + segment +
            b"\xff\xda\0\x02 pixels \xff\xd9")


def dated(seconds):
    return (datetime.datetime.fromtimestamp(NOON_S + seconds, datetime.timezone.utc)).strftime("%Y:%m:%d %H:%M:%S")


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "1.jpg")

    def taken(self, content):
        self.path.write_bytes(content)
        return exif.taken(self.path)


class Exif(Folder):
    def test_tells_when_a_picture_was_taken_and_how_exactly(self):
        for order in "<>":
            for before in (b"", JFIF, JFIF + XMP):
                for fraction, expected_s, unit_s in (("5", 0.5, 0.1), ("047", 0.047, 0.001), ("12345", 0.12345, 1e-5),
                                                     ("00", 0.0, 1.0), (None, 0.0, 1.0), ("", 0.0, 1.0),
                                                     ("  ", 0.0, 1.0)):
                    taken = self.taken(jpeg("2026:05:01 12:00:00", fraction, order, before))
                    self.assertAlmostEqual(taken.date_s, NOON_S + expected_s, places=5)
                    self.assertAlmostEqual(taken.unit_s, unit_s)

    def test_tells_nothing_where_there_is_none_or_it_is_damaged(self):
        whole = jpeg("2026:05:01 12:00:00", "5")
        for content in (b"", b"\xff\xd8", b"\xff\xd8\xff\xd9", b"\x89PNG", jpeg("0000:00:00 00:00:00"),
                        jpeg("yesterday"), *(whole[:size] for size in range(40, 90))):
            self.assertIsNone(self.taken(content), content)
        chance = random.Random(7)
        for _ in range(500):
            spoilt = bytearray(whole)
            for _ in range(3):
                spoilt[chance.randrange(len(spoilt))] = chance.randrange(256)
            self.taken(bytes(spoilt))


class Latenesses(Folder):
    def late(self, lateness, taken_s, written, fraction=True):
        """Whether the picture is, and what was said."""
        taken_s += 0.001  # zeros alone would be no fraction
        self.path.write_bytes(jpeg(dated(taken_s), f"{taken_s % 1.0:.3f}"[2:] if fraction else None))
        with said() as words:
            return lateness.is_late(self.path, written), words.getvalue()

    def test_that_grow_are_told_and_prompt_pictures_are_taken_again(self):
        lateness, begin = Lateness(), 5000.0
        for number in range(10):
            late_s = 0.7 + 0.1 * number
            is_late, words = self.late(lateness, 2.0 * number, begin + 2.0 * number + late_s)
            self.assertEqual(is_late, number > 3, number)
            self.assertEqual(f"came {0.1 * number:.1f} s later" in words, is_late)
        self.assertEqual(self.late(lateness, 20.0, begin + 20.0 + 0.8), (False, ""))

    def test_of_cameras_that_tell_whole_seconds_are_told_once_they_are_sure(self):
        lateness = Lateness()
        for number in range(30):
            taken_s = 1.37 * number
            self.assertEqual(self.late(lateness, taken_s, 5000.0 + taken_s, False), (False, ""), number)
        self.assertEqual(self.late(lateness, 50.0, 5051.2, False), (False, ""))
        self.assertTrue(self.late(lateness, 52.0, 5053.5, False)[0])

    def test_are_measured_from_the_promptest_picture_and_not_of_the_cameras_clock(self):
        lateness = Lateness()
        self.assertFalse(self.late(lateness, 0.0, 5001.5)[0], "nobody knows that this one is late")
        self.assertFalse(self.late(lateness, 2.0, 5002.5)[0])
        self.assertTrue(self.late(lateness, 4.0, 5005.5)[0])
        for pace in (1.00005, 0.99995):
            lateness = Lateness()
            for minute in range(300):
                self.assertFalse(self.late(lateness, 60.0 * minute * pace, 5000.0 + 60.0 * minute)[0], (pace, minute))

    def late_number(self, lateness, name, written):
        with said():
            return lateness.is_late(self.path.with_name(name), written)

    def test_of_a_stream_are_told_by_the_numbers_of_its_frames(self):
        lateness = Lateness(2.0)
        for number, late_s, is_late in ((1, 0.5, False), (2, 0.7, False), (3, 0.9, True), (5, 0.6, False),
                                        (6, 0.1, False), (7, 0.5, True)):
            written = 100.0 + 2.0 * number + late_s
            self.assertEqual(self.late_number(lateness, f"17-{number:06}.jpg", written), is_late, number)
        for name, written, is_late in (("18-000001.jpg", 200.0, False), ("18-000002.jpg", 202.4, True),
                                       ("18-000001.jpg", 210.0, False), ("18-000002.jpg", 212.4, True),
                                       ("photo.jpg", 300.0, False)):
            self.assertEqual(self.late_number(lateness, name, written), is_late, name)

    def test_of_a_stream_are_told_also_after_a_picture_that_comes_out_of_order(self):
        for again in (2, 3):
            lateness = Lateness(1.0)
            for number, written, is_late in ((1, 100.0, False), (2, 101.0, False), (3, 104.0, True),
                                             (again, 104.1, True), (4, 104.2, True), (5, 105.2, True),
                                             (6, 105.1, False)):
                self.assertEqual(self.late_number(lateness, f"f{number:04}.jpg", written), is_late, (again, number))

    def test_of_a_stream_that_begins_anew_are_measured_from_its_first_picture(self):
        for first in (0, 1, 50):  # a ring of names goes on anywhere
            lateness = Lateness(1.0)
            self.assertFalse(self.late_number(lateness, "f0100.jpg", 200.0))
            self.assertFalse(self.late_number(lateness, f"f{first:04}.jpg", 300.0), first)
            self.assertTrue(self.late_number(lateness, f"f{first + 1:04}.jpg", 302.0), first)

    def test_of_two_cameras_in_one_folder_are_told_by_the_numbers_of_each(self):
        lateness = Lateness(1.0)
        for number in range(1, 6):
            for camera, begin in (("a", 100.0), ("b", 200.0)):
                self.assertEqual(self.late_number(lateness, f"{camera}{number:04}.jpg", begin + 1.2 * number),
                                 number > 2, (camera, number))

    def test_keep_pictures_of_a_folder_back(self):
        clock = types.SimpleNamespace(monotonic=lambda date_s: date_s - NOON_S, was_set=False)
        pictures = NewPictures(self.path.parent, clock)
        for number, late_s in enumerate((0.25, 0.35, 1.25, 0.3)):
            self.path = self.path.with_name(f"{number}.jpg")
            self.path.write_bytes(jpeg(dated(number), "1"))
            os.utime(self.path, (NOON_S + number + late_s,) * 2)
            with said() as words:
                self.assertEqual([path.name for path, _ in pictures()], [] if number == 2 else [f"{number}.jpg"])
            self.assertEqual("2.jpg is left out: it came 0.9 s later" in words.getvalue(), number == 2)

    def test_keep_frames_of_a_stream_back(self):
        clock = types.SimpleNamespace(monotonic=lambda date_s: date_s - NOON_S, was_set=False)
        pictures = NewPictures(self.path.parent, clock, 1.0)
        for number in range(8):
            self.path = self.path.with_name(f"17-{number:06}.jpg")
            self.path.write_bytes(b"\xff\xd8\xff\xd9")
            os.utime(self.path, (NOON_S + 1.1 * number + 0.25,) * 2)
            with said() as words:
                self.assertEqual(len(pictures()), 1 if number < 4 else 0, number)
            self.assertEqual("or --every is wrong" in words.getvalue(), number >= 4)
            self.assertTrue(pictures.have_come)
        self.assertEqual(pictures(), [])
        self.assertFalse(pictures.have_come)

    def test_are_none_where_the_picture_does_not_say_when_it_was_taken(self):
        lateness = Lateness()
        for written in (1.0, 20.0):
            self.path.write_bytes(b"\xff\xd8\xff\xd9")
            self.assertFalse(lateness.is_late(self.path, written))
        self.path.unlink()
        self.assertFalse(lateness.is_late(self.path, 30.0))


if __name__ == "__main__":
    unittest.main()
