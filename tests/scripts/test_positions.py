#!/usr/bin/python3
"""How old a position is, by whatever tells of it."""
import unittest
from unittest import mock

import fake_service  # noqa: F401: the folder of the program

from steps import Line, captured

NOW_S = 5000.0  # since the start of the computer
DATE_S = 1.7e9


class Ages(unittest.TestCase):
    """In seconds, of a line that came `came_s_ago`, by its times."""

    def setUp(self):
        for name, now in (("monotonic", NOW_S), ("time", DATE_S)):
            patch = mock.patch(f"time.{name}", lambda now=now: now)
            patch.start()
            self.addCleanup(patch.stop)

    def age_s(self, by_date_s, came_s_ago=0.3, **members):
        line = Line(1, NOW_S - came_s_ago, 0, members)
        return NOW_S - captured(line, {"time_us": 1e6 * (DATE_S - by_date_s)})

    def test_go_by_the_date_or_the_line_whichever_is_longer_ago(self):
        self.assertAlmostEqual(self.age_s(2.3), 2.3, places=5)
        self.assertAlmostEqual(self.age_s(0.1), 0.3)
        self.assertAlmostEqual(self.age_s(0.1, came_s_ago=8.0), 8.0)

    def test_go_by_the_line_where_the_date_lies_ahead(self):
        for ahead_s in (1e-3, 0.5, 2.0, 30.0, 1e6):
            self.assertAlmostEqual(self.age_s(-ahead_s), 0.3)

    def test_go_by_the_line_where_the_date_is_of_a_recording(self):
        self.assertAlmostEqual(self.age_s(599.0), 599.0, places=5)
        self.assertAlmostEqual(self.age_s(601.0), 0.3)

    def test_go_by_the_clock_of_the_computer_whatever_the_date(self):
        for by_date_s in (2.3, 1.3, 0.3, -27.7, 1e6):
            self.assertAlmostEqual(self.age_s(by_date_s, monotonic_s=NOW_S - 2.3), 2.3)
        self.assertAlmostEqual(self.age_s(2.3, monotonic_s=NOW_S - 700.0), 700.0, msg="it waited in the pipe")
        self.assertAlmostEqual(self.age_s(2.3, monotonic_s=NOW_S - 0.1), 0.3, msg="not from before its line came")

    def test_go_by_the_date_where_the_clock_of_the_computer_is_of_another_one(self):
        for other_s in (NOW_S + 0.1, -0.1):
            self.assertAlmostEqual(self.age_s(2.3, monotonic_s=other_s), 2.3, places=5)


if __name__ == "__main__":
    unittest.main()
