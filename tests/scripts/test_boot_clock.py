#!/usr/bin/python3
"""Times since the start of an autopilot by the clock of this computer."""
import sys
import unittest
from pathlib import Path

from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from boot_clock import BootClock  # noqa: E402


class BootClocks(unittest.TestCase):
    def test_that_drift_are_followed(self):
        for drift in (-5e-5, 5e-5):
            clock = BootClock()
            for came in range(100, 3700):
                ours = clock.ours((came - 90) * (1.0 + drift), came + (0.0 if came % 10 == 0 else 0.3))
                self.assertLess(abs(ours - came), 0.002)

    def count(self, clock, from_s, to_s, came):
        """Messages of so many seconds since a start, ten a second, as they come: what the clock makes of each."""
        return [clock.ours(from_s + 0.1 * i, came + 0.1 * i) for i in range(round(10 * (to_s - from_s)) + 1)]

    def test_take_messages_that_are_late_by_less_than_a_second_but_not_one_after_the_other(self):
        clock = BootClock()
        clock.ours(10.0, 110.0)
        for boot_s, ours in ((9.1, 109.1), (8.9, None), (9.01, 109.01)):
            self.assertEqual(clock.ours(boot_s, 110.5), ours)

    def test_are_those_of_a_restarted_autopilot_once_it_has_counted_on_for_a_second(self):
        clock = BootClock()
        self.count(clock, 50.0, 60.0, 150.0)
        with said() as words:
            times = self.count(clock, 2.0, 3.5, 165.0)
        self.assertEqual(times[:10], [None] * 10)
        for time, came in zip(times[10:], (166.0, 166.1, 166.2, 166.3, 166.4, 166.5), strict=True):
            self.assertAlmostEqual(time, came)
        self.assertEqual(words.getvalue(), "the autopilot was started again\n")

    def test_are_not_those_of_a_restart_where_single_messages_come_late(self):
        clock = BootClock()
        self.count(clock, 50.0, 60.0, 150.0)
        for came, boot_s in ((161.0, 2.0), (163.5, 55.0), (165.0, 3.0), (166.5, 58.5)):
            self.assertIsNone(clock.ours(boot_s, came), "none of them counts on from the one before")
        self.assertAlmostEqual(clock.ours(67.0, 167.0), 167.0)

    def test_are_not_those_of_a_restart_where_the_slow_one_of_two_links_is_left(self):
        clock = BootClock()
        with said() as words:
            self.count(clock, 50.0, 60.0, 150.0)
            times = self.count(clock, 51.0, 70.0, 160.1)
        self.assertEqual(words.getvalue(), "")
        self.assertEqual(times[:80], [None] * 80)
        self.assertAlmostEqual(times[-1], 170.0, delta=0.01, msg="not when it came")

    def test_are_those_of_another_vehicle_once_it_has_counted_on_for_longer_than_a_link_is_slow(self):
        clock = BootClock()
        self.count(clock, 500.0, 510.0, 600.0)
        with said() as words:
            times = self.count(clock, 200.0, 211.0, 612.0)
        self.assertEqual(times[:100], [None] * 100)
        self.assertAlmostEqual(times[-1], 623.0)
        self.assertEqual(words.getvalue().count("started again"), 1)


if __name__ == "__main__":
    unittest.main()
