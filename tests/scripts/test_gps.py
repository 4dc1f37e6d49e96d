#!/usr/bin/python3
"""Where a vehicle was while it had GPS."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from gps import Gps  # noqa: E402
from history import Unknown  # noqa: E402
from vehicle import Vehicle  # noqa: E402

NORTH_M = 1.0 / 111_200.0  # degrees of latitude


def flown(*places, fixes=((100.0, 3), (101.0, 3), (102.0, 3)), lat=37.0, lon=38.0):
    """`places`: time, latitude, longitude. `fixes`: when each came and of what type, all at one place."""
    gps = Gps()
    for when, *place in places:
        gps.tell_place(*place, when)
    for came, fix_type in fixes:
        gps.tell_fix(fix_type, lat, lon, came)
    return gps


class Places(unittest.TestCase):
    def assert_unknown(self, gps, when, why):
        with self.assertRaisesRegex(Unknown, why):
            gps.place_at(when)

    def test_lie_between_those_that_the_estimator_told(self):
        gps = flown((100.2, 37.0, 38.0), (100.7, 37.0001, 38.0004), (101.2, 37.0003, 38.0004))
        for when, place in ((100.2, (37.0, 38.0)), (100.45, (37.00005, 38.0002)), (100.7, (37.0001, 38.0004)),
                            (101.1, (37.00026, 38.0004))):
            for actual, expected in zip(gps.place_at(when), place):
                self.assertAlmostEqual(actual, expected, places=9)

    def test_lie_on_the_short_way_over_the_date_line(self):
        for first, second, between in ((179.9999, -179.9997, -179.9999), (-179.9999, 179.9997, 179.9999)):
            gps = flown((100.2, -17.0, first), (101.2, -17.0, second), lat=-17.0, lon=first)
            self.assertAlmostEqual(gps.place_at(100.7)[1], between, places=9)

    def test_are_not_known_before_after_or_far_between_what_was_told(self):
        gps = flown((100.2, 37.0, 38.0), (101.35, 37.0, 38.0), (102.6, 37.0, 38.0))
        self.assertEqual(gps.place_at(101.0), (37.0, 38.0))
        for when in (100.1, 102.0, 102.8):
            self.assert_unknown(gps, when, "no two GLOBAL_POSITION_INT around that time, at most 1.2 s apart")
        self.assert_unknown(flown(), 100.5, "no two GLOBAL_POSITION_INT")

    def test_stay_where_they_were_told_first_whatever_comes_late(self):
        gps = flown((100.2, 37.0, 38.0), (101.2, 37.0001, 38.0), (100.7, 39.0, 39.0))
        self.assertAlmostEqual(gps.place_at(100.7)[0], 37.00005, places=9)

    def test_count_only_while_the_receiver_has_a_fix_in_space(self):
        places = [(100.0 + 0.5 * i, 37.0, 38.0) for i in range(20)]
        for fixes, why in (((), "no GPS_RAW_INT in the 2.5 s before it"),
                           (((102.1, 3),), "no GPS_RAW_INT"), (((99.4, 3), (102.1, 3)), "no GPS_RAW_INT"),
                           (((101.0, 2), (102.1, 3)), "had no 3D fix"), (((101.0, 3), (102.1, 1)), "had no 3D fix"),
                           (((101.0, 0),), "had no 3D fix")):
            self.assert_unknown(flown(*places, fixes=fixes), 102.0, why)
        for fixes in (((101.0, 3), (102.1, 6)), ((99.6, 4),), ((101.0, 3), (104.6, 1)), ((100.0, 1), (101.0, 3))):
            self.assertEqual(flown(*places, fixes=fixes).place_at(102.0), (37.0, 38.0), fixes)

    def test_count_only_where_the_estimator_is_near_its_receiver(self):
        """Else it goes on by something else, as by a camera's positions."""
        for north_m, is_near in ((45.0, True), (-45.0, True), (55.0, False), (-55.0, False)):
            degrees = north_m * NORTH_M
            for gps in (flown(*((when, 37.0, 38.0) for when in (100.0, 101.0, 102.0)), lat=37.0 + degrees),
                        flown(*((when, 60.0, 0.0) for when in (100.0, 101.0, 102.0)), lat=60.0, lon=2.0 * degrees)):
                if is_near:
                    gps.place_at(100.5)
                else:
                    self.assert_unknown(gps, 100.5, "the autopilot was not within 50 m of where its GPS was")

    def test_of_a_quick_vehicle_are_near_where_its_receiver_was_when_it_told(self):
        gps = Gps()
        for i in range(41):  # 60 m/s
            gps.tell_place(37.0 + 6.0 * i * NORTH_M, 38.0, 100.0 + 0.1 * i)
        for came in (100.5, 102.5):
            gps.tell_fix(3, 37.0 + 60.0 * (came - 100.3) * NORTH_M, 38.0, came)  # 0.3 s late
        self.assertAlmostEqual(gps.place_at(102.4)[0], 37.0 + 144.0 * NORTH_M, places=9)

    def test_are_those_that_an_autopilot_tells_whatever_its_clock_and_the_delays_of_the_link(self):
        vehicle = Vehicle()
        for i, late_s in enumerate((0.0, 0.1, 0.3, 0.2, 0.3)):
            vehicle.hear("GPS_RAW_INT", {"fix_type": 3, "lat": 370_000_000, "lon": -1_222_571_987}, 500.0 + i)
            vehicle.hear("GLOBAL_POSITION_INT", {"time_boot_ms": 3000 + 500 * i, "relative_alt": 0,
                                                 "lat": 370_000_000 + 40 * i, "lon": -1_222_571_987},
                         500.0 + 0.5 * i + late_s)
        lat, lon = vehicle.gps_place_at(500.75)
        self.assertAlmostEqual(lat, 37.000006, places=8)
        self.assertAlmostEqual(lon, -122.2571987, places=9)


if __name__ == "__main__":
    unittest.main()
