#!/usr/bin/python3
"""Where a vehicle was and how high, by flights whose truth is known."""
import math
import random
import sys
import unittest
from pathlib import Path

from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from history import Unknown  # noqa: E402
from vehicle import Vehicle  # noqa: E402


def hud(airspeed, alt=1e-4):
    return {"airspeed": airspeed, "alt": alt}


def altitude(above_ground_m, above_sea_m=0.0, by_pressure_m=math.nan):
    return {"bottom_clearance": above_ground_m, "altitude_amsl": above_sea_m, "altitude_monotonic": by_pressure_m}


def turn(vehicle, came, roll=0.0, pitch=0.0, yaw=0.0):
    vehicle.hear("ATTITUDE", {"time_boot_ms": round(1e3 * came), "roll": roll, "pitch": pitch, "yaw": yaw}, came)


def move(vehicle, came, north=0.0, east=0.0, height_m=80.0):
    """At a velocity."""
    fields = {"time_boot_ms": round(1e3 * came), "z": -height_m, "vx": north, "vy": east}
    vehicle.hear("LOCAL_POSITION_NED", fields, came)


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
        for t in (15.03, 30.0, 30.04, 44.97, 59.9):  # at 30 it looks south
            (north, east), (roll, _, yaw) = vehicle.seen_at(1000.0 + t)
            self.assertAlmostEqual(north, radius_m * math.sin(rate * t), delta=0.15)
            self.assertAlmostEqual(east, radius_m * (1.0 - math.cos(rate * t)), delta=0.15)
            self.assertAlmostEqual(math.remainder(yaw - rate * t, math.tau), 0.0, delta=0.002)
            self.assertAlmostEqual(roll, 0.1)
        self.assertEqual(vehicle.agl_m(vehicle.heard), 80.0)

    def test_are_between_places_as_far_as_time_has_passed(self):
        vehicle = Vehicle()
        for second in range(4):
            turn(vehicle, 10.0 + second)
            turn(vehicle, 10.5 + second)
            move(vehicle, 10.0 + second, north=10.0 * second)  # 10 m/s2
        for after_s in (1.9, 2.1, 2.9):
            self.assertAlmostEqual(vehicle.seen_at(10.0 + after_s)[0][0], 5.0 * after_s * after_s, delta=0.5)

    def test_by_air_go_where_the_nose_points(self):
        vehicle = Vehicle(by_air=True)
        for i in range(11):
            vehicle.hear("ATTITUDE", {"time_boot_ms": 100 * i, "roll": 0, "pitch": 0, "yaw": 0.5 * math.pi}, 5.0 + 0.1 * i)
            vehicle.hear("VFR_HUD", hud(20.0), 5.0 + 0.1 * i)
            vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": 100 * i, "z": -9, "vx": 3.0, "vy": 0.0}, 5.0 + 0.1 * i)
        (north, east), _ = vehicle.seen_at(6.0)
        self.assertAlmostEqual(north, 0.0, places=6)
        self.assertAlmostEqual(east, 20.0, places=6)

    def test_are_high_above_ground_where_the_autopilot_knows_it_and_else_above_the_take_off(self):
        vehicle = Vehicle(takeoff_agl_m=12.0)
        with self.assertRaises(Unknown):
            vehicle.agl_m(vehicle.heard)
        vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": 0, "z": -80.0, "vx": 0.0, "vy": 0.0}, 1.0)
        self.assertEqual(vehicle.agl_m(vehicle.heard), 92.0)
        vehicle.hear("TERRAIN_REPORT", {"spacing": 0, "current_height": 0.0}, 1.0)
        vehicle.hear("ALTITUDE", altitude(math.nan), 1.0)
        self.assertEqual(vehicle.agl_m(vehicle.heard), 92.0, "neither knows the ground")
        vehicle.hear("TERRAIN_REPORT", {"spacing": 100, "current_height": 70.0}, 1.0)
        with said() as words:
            self.assertEqual(vehicle.agl_m(vehicle.heard), 70.0)
        self.assertEqual(words.getvalue(), "the height above ground is known now\n")

    def test_are_as_high_as_above_the_take_off_which_need_not_be_where_the_estimator_began(self):
        vehicle = Vehicle(takeoff_agl_m=3.0)
        for home_z, height_m in ((None, 83.0), (-12.25, 70.75), (math.nan, 70.75), (5.0, 88.0), (0.0, 83.0)):
            if home_z is not None:
                vehicle.hear("HOME_POSITION", {"z": home_z}, 1.0)
            move(vehicle, 1.0, height_m=80.0)
            self.assertEqual(vehicle.agl_m(vehicle.heard), height_m, home_z)

    def test_are_as_high_above_the_take_off_as_is_told_where_the_estimator_has_no_origin(self):
        vehicle = Vehicle(takeoff_agl_m=3.0)
        for came, relative_alt in ((1.0, 40_500), (2.0, 41_500)):
            vehicle.hear("GLOBAL_POSITION_INT", {"time_boot_ms": 1e3 * came, "lat": 0, "lon": 0,
                                                 "relative_alt": relative_alt}, came)
            self.assertEqual(vehicle.agl_m(vehicle.heard), 1e-3 * relative_alt + 3.0)
        move(vehicle, 2.0, height_m=80.0)
        self.assertEqual(vehicle.agl_m(vehicle.heard), 83.0)

    def test_are_no_longer_as_high_above_ground_as_was_told_seconds_ago(self):
        vehicle = Vehicle(takeoff_agl_m=12.0)
        with said() as words:
            vehicle.hear("ALTITUDE", altitude(35.0), 1.0)
            for came in (1.5, 2.0, 3.0, 4.0, 5.0):
                move(vehicle, came, height_m=50.0 * came)
                self.assertEqual(vehicle.agl_m(vehicle.heard), 35.0 if came < 3.5 else 50.0 * came + 12.0)
            self.assertEqual(words.getvalue().count("not known any more"), 1)
            vehicle.hear("ALTITUDE", altitude(36.0), 5.0)
            self.assertEqual((vehicle.agl_m(vehicle.heard), vehicle.agl_m(vehicle.heard)), (36.0, 36.0))
            self.assertEqual(words.getvalue().count("known now"), 1)

    def test_are_no_longer_above_ground_that_the_autopilot_lost(self):
        for name, fields, height_m in (
                ("ALTITUDE", altitude(math.nan), 80.0), ("ALTITUDE", altitude(-1.0), 80.0),
                ("ALTITUDE", altitude(math.inf), 80.0), ("ALTITUDE", altitude(0.0), 80.0),
                ("ALTITUDE", altitude(0.4), 0.4),
                ("TERRAIN_REPORT", {"spacing": 0, "current_height": 300.0}, 80.0),
                ("TERRAIN_REPORT", {"spacing": 0, "current_height": 0.0}, 70.0),  # of another place, asked for
                ("ALTITUDE", altitude(60.0), 60.0)):
            vehicle = Vehicle()
            move(vehicle, 1.0)
            vehicle.hear("TERRAIN_REPORT", {"spacing": 100, "current_height": 70.0}, 1.0)
            vehicle.hear(name, fields, 1.1)
            self.assertEqual(vehicle.agl_m(vehicle.heard), height_m, (name, fields))

    def test_by_air_have_a_height_where_the_velocity_over_ground_is_unknown(self):
        vehicle = Vehicle(by_air=True)
        vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": 0, "z": -80.0, "vx": math.nan, "vy": math.nan}, 1.0)
        self.assertEqual(vehicle.agl_m(vehicle.heard), 80.0)

    def test_have_no_height_that_was_heard_long_ago(self):
        vehicle = Vehicle(by_air=True)
        move(vehicle, 1.0)
        vehicle.hear("VFR_HUD", hud(20.0), 9.0)
        with self.assertRaisesRegex(Unknown, "no height"):
            vehicle.agl_m(vehicle.heard)

    def test_are_as_high_above_the_sea_as_the_better_message_told_last(self):
        vehicle = Vehicle()
        self.assertIsNone(vehicle.alt_m(vehicle.heard))
        for came, name, fields, alt_m in (
                (1.0, "VFR_HUD", hud(20.0, 512.0), 512.0),
                (1.5, "ALTITUDE", altitude(80.0, 519.0), 519.0),
                (2.0, "VFR_HUD", hud(20.0, 530.0), 519.0),
                (3.5, "ALTITUDE", altitude(80.0, math.nan), 530.0),
                (4.0, "VFR_HUD", hud(20.0, 1e9), None),
                (5.0, "VFR_HUD", hud(20.0, 540.0), 540.0)):
            vehicle.hear(name, fields, came)
            self.assertEqual(vehicle.alt_m(vehicle.heard), alt_m, (name, fields))
        move(vehicle, 8.0)
        self.assertIsNone(vehicle.alt_m(vehicle.heard), "heard long ago")

    def test_are_as_high_above_the_sea_as_nobody_knows_before_the_autopilot_has_an_origin(self):
        vehicle = Vehicle()
        with said() as words:
            for came in (1.0, 1.2):
                vehicle.hear("VFR_HUD", hud(20.0, 0.0), came)
            self.assertIsNone(vehicle.alt_m(vehicle.heard), "an ArduPilot copter without one tells 0, however high")
            vehicle.hear("VFR_HUD", hud(20.0, 705.25), 1.4)
            self.assertEqual(vehicle.alt_m(vehicle.heard), 705.25)
        self.assertEqual(words.getvalue().count("no origin yet (SET_GPS_GLOBAL_ORIGIN)"), 1)

    def test_are_said_to_be_as_high_as_the_barometer_alone_tells_before_the_autopilot_has_an_origin(self):
        for by_pressure_m, is_said in (((705.25, 706.0, 706.5), 1), ((705.5, 706.25, 706.75), 0),
                                       ((705.25, 706.25, 706.5), 0), ((math.nan, math.nan, math.nan), 0)):
            vehicle = Vehicle()
            with said() as words:
                for came, above_sea_m, barometer_m in zip((1.0, 2.0, 3.0), (705.25, 706.0, 706.5), by_pressure_m):
                    vehicle.hear("ALTITUDE", altitude(80.0, above_sea_m, barometer_m), came)
            self.assertEqual(words.getvalue().count("barometer alone"), is_said, by_pressure_m)
            self.assertEqual(vehicle.alt_m(vehicle.heard), 706.5)

    def test_have_moved_nobody_knows_where_while_nothing_was_heard(self):
        vehicle = Vehicle()
        for tenth in range(100, 360):
            if tenth in (100, 110, 130, 330, 340):
                move(vehicle, 0.1 * tenth, north=1.0)
            turn(vehicle, 0.1 * tenth)
        self.assertEqual([vehicle.holes_before(when) for when in (10.0, 11.0, 32.9, 33.0, 34.0)], [0, 0, 0, 1, 1])
        for when, north_m in ((10.0, 0.0), (10.5, 0.5), (12.0, 2.0), (33.0, 3.0), (34.0, 4.0)):
            self.assertAlmostEqual(vehicle.seen_at(when)[0][0], north_m, msg=str(when))
        for when in (14.1, 23.0, 32.9, 35.1):
            self.assertIsNone(vehicle.seen_at(when)[0])

    def test_go_on_for_a_second_as_they_went_last(self):
        vehicle = Vehicle()
        for tenth in range(100, 120):
            if tenth in (100, 105):
                move(vehicle, 0.1 * tenth, north=3.0, east=-4.0)
            turn(vehicle, 0.1 * tenth)
        for when in (10.5, 11.0, 11.49):
            (north, east), _ = vehicle.seen_at(when)
            self.assertAlmostEqual(north, 3.0 * (when - 10.0))
            self.assertAlmostEqual(east, -4.0 * (when - 10.0))
        self.assertIsNone(vehicle.seen_at(11.51)[0])

    def test_have_no_attitude_of_moments_between_which_they_may_have_banked(self):
        vehicle = Vehicle()
        rolls = {10.0: 0.0, 10.2: 0.1, 10.79: 0.3, 11.4: 0.5, 11.6: 0.5}
        for came in sorted([*rolls, *(10.0 + 0.1 * tenth for tenth in range(50))]):
            move(vehicle, came)
            if came in rolls:
                turn(vehicle, came, roll=rolls[came])
        self.assertAlmostEqual(vehicle.seen_at(10.1)[1][0], 0.05)
        self.assertAlmostEqual(vehicle.seen_at(10.495)[1][0], 0.2, msg="0.59 s between two")
        for when in (9.95, 10.8, 11.1, 11.39, 11.61, 12.6):
            with self.assertRaisesRegex(Unknown, "no two ATTITUDE around that time"):
                vehicle.seen_at(when)
        self.assertAlmostEqual(vehicle.seen_at(11.4)[1][0], 0.5, msg="after 0.61 s it is known again")

    def test_outlast_a_restart_of_the_autopilot(self):
        vehicle = Vehicle()
        with said() as words:
            for tenth in (*range(1000, 1010), *range(1025, 1045)):
                boot_ms = 100 * tenth - (10_000 if tenth < 1010 else 102_000)
                vehicle.hear("ATTITUDE", {"time_boot_ms": boot_ms, "roll": 0, "pitch": 0, "yaw": 0}, 0.1 * tenth)
                vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": boot_ms, "z": 0, "vx": 2, "vy": 0}, 0.1 * tenth)
        self.assertEqual(words.getvalue(), "the autopilot was started again\n")
        self.assertEqual(vehicle.holes_before(104.0), 1)
        self.assertAlmostEqual(vehicle.seen_at(104.0)[0][0] - vehicle.seen_at(103.6)[0][0], 0.8, places=2)

    def test_are_the_same_where_a_slow_link_brings_each_message_again(self):
        rate = math.radians(15.0)
        for late_s in (0.5, 1.2, 3.0, 30.0):
            messages = [(0.1 * tenth + after_s, 0.1 * tenth) for tenth in range(600) for after_s in (0.05, late_s)]
            vehicle = Vehicle()
            with said() as words:
                for came, t in sorted(message for message in messages if message[0] < 60.0):
                    boot_ms, yaw = round(1e3 * t), rate * t
                    vehicle.hear("ATTITUDE", {"time_boot_ms": boot_ms, "roll": 0.01 * t, "pitch": 0, "yaw": yaw}, came)
                    vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": boot_ms, "z": -t, "vx": 20 * math.cos(yaw),
                                                        "vy": 20 * math.sin(yaw)}, came)
            self.assertEqual(words.getvalue(), "")
            for t in (20.03, 31.0, 44.44):
                (north, east), (roll, _, yaw) = vehicle.seen_at(t + 0.05)
                self.assertAlmostEqual(north, 20.0 / rate * math.sin(rate * t), delta=0.1)
                self.assertAlmostEqual(east, 20.0 / rate * (1.0 - math.cos(rate * t)), delta=0.1)
                self.assertAlmostEqual(math.remainder(yaw - rate * t, math.tau), 0.0, places=3)
                self.assertAlmostEqual(roll, 0.01 * t, places=3)

    def test_bank_as_they_did_last_whatever_comes_late(self):
        vehicle = Vehicle()
        for came, sent, roll in ((10.0, 10.0, 0.1), (10.2, 10.2, 0.2), (10.3, 10.1, 0.9), (10.4, 10.4, 0.4)):
            fields = {"time_boot_ms": round(1e3 * sent), "roll": roll, "pitch": 0.0, "yaw": 0.0}
            vehicle.hear("ATTITUDE", fields, came)
        for when, roll in ((10.1, 0.15), (10.2, 0.2), (10.3, 0.3)):
            self.assertAlmostEqual(vehicle.seen_at(when)[1][0], roll, places=3)

    def test_are_not_as_high_as_a_slow_link_tells_later(self):
        vehicle = Vehicle()
        for came, boot_s in ((10.0, 10.0), (12.0, 12.0), (12.1, 10.0)):
            vehicle.hear("LOCAL_POSITION_NED", {"time_boot_ms": 1e3 * boot_s, "z": -10 * boot_s, "vx": 0, "vy": 0}, came)
        self.assertEqual(vehicle.agl_m(vehicle.heard), 120.0)

    def test_are_as_high_as_they_were_at_the_time_that_is_asked_for(self):
        vehicle = Vehicle()
        for second in range(11):  # a climb at 5 m/s
            move(vehicle, 10.0 + second, height_m=190.0 + 5.0 * second)
            vehicle.hear("ALTITUDE", altitude(200.0 + 5.0 * second, 600.0 + 5.0 * second), 10.0 + second)
        for when, climbed_m in ((10.0, 0.0), (18.0, 40.0), (18.4, 40.0), (18.6, 45.0), (20.0, 50.0), (9.0, 0.0)):
            self.assertEqual((vehicle.agl_m(when), vehicle.alt_m(when)), (200.0 + climbed_m, 600.0 + climbed_m), when)
        self.assertIsNone(vehicle.alt_m(7.0), "it was told too long after")

    def test_do_not_take_what_is_no_number(self):
        for nothing in (math.nan, math.inf, -math.inf):
            for message, fields in (("ATTITUDE", ("roll", "pitch", "yaw")), ("LOCAL_POSITION_NED", ("vx", "vy"))):
                for field in fields:
                    vehicle = Vehicle()
                    for tenth in range(100, 111):
                        move(vehicle, 0.1 * tenth, north=10.0)
                        turn(vehicle, 0.1 * tenth, roll=0.2, yaw=0.3)
                        if tenth == 105:
                            known = {"z": -80.0, "vx": 10.0, "vy": 0.0, "roll": 0.2, "pitch": 0.0, "yaw": 0.3}
                            vehicle.hear(message, {"time_boot_ms": 10_550, **known, field: nothing}, 10.55)
                    for when in (10.55, 11.0):
                        (north, east), attitude = vehicle.seen_at(when)
                        self.assertAlmostEqual(north, 10.0 * (when - 10.0))
                        self.assertAlmostEqual(east, 0.0)
                        self.assertEqual(tuple(round(angle, 9) for angle in attitude), (0.2, 0.0, 0.3))

    def test_do_not_take_for_ever_what_was_absurd_once(self):
        for absurd in (1e30, -3e38, 1001.0):
            vehicle = Vehicle()
            vehicle.hear("HOME_POSITION", {"z": -20.0}, 10.0)
            vehicle.hear("HOME_POSITION", {"z": 100.0 * absurd}, 10.0)
            for tenth in range(100, 121):
                move(vehicle, 0.1 * tenth, *((absurd, absurd) if tenth == 105 else (10.0, 5.0)))
                turn(vehicle, 0.1 * tenth)
            (north, east), _ = vehicle.seen_at(12.0)
            self.assertAlmostEqual(north, 20.0)
            self.assertAlmostEqual(east, 10.0)
            self.assertAlmostEqual(vehicle.agl_m(12.0), 60.0)

    def test_do_not_go_on_at_a_velocity_that_the_autopilot_lost(self):
        vehicle = Vehicle()
        for tenth in range(100, 200):
            turn(vehicle, 0.1 * tenth)
            move(vehicle, 0.1 * tenth, north=10.0 if tenth < 120 else math.nan)
        self.assertIsNone(vehicle.seen_at(15.0)[0])

    def test_have_moved_nobody_knows_where_while_the_estimator_knows_no_velocity(self):
        for status in ("ESTIMATOR_STATUS", "EKF_STATUS_REPORT"):
            vehicle = Vehicle()
            for tenth in range(10, 200):
                came = 0.1 * tenth
                if tenth in (60, 120):  # it loses what aids it, and gets it back
                    vehicle.hear(status, {"flags": 0b11 if tenth == 120 else 0b1000_0001}, came)
                move(vehicle, came, north=0.0 if 60 <= tenth < 120 else 10.0)
                turn(vehicle, came)
            for when, is_known in ((5.0, True), (6.5, True), (7.5, False), (11.5, False), (12.5, True)):
                self.assertEqual(vehicle.seen_at(when)[0] is not None, is_known, when)
            self.assertAlmostEqual(vehicle.seen_at(6.5)[0][0] - vehicle.seen_at(5.0)[0][0], 15.0)
            self.assertEqual((vehicle.holes_before(11.9), vehicle.holes_before(12.1)), (0, 1))

    def test_are_known_without_velocities_where_these_have_ended(self):
        vehicle = Vehicle()
        for tenth in range(100, 130):
            turn(vehicle, 0.1 * tenth)
            if tenth <= 115:
                move(vehicle, 0.1 * tenth)
        for when, knows in ((11.5, True), (11.6, False), (12.49, False), (12.51, True), (12.9, True), (12.91, False)):
            self.assertEqual(vehicle.knows(when), knows, when)


class FlightsByAir(unittest.TestCase):
    def test_are_as_fast_as_the_thin_air_of_their_height_lets_them(self):
        # ISO 2533: densities of 1.225, 1.0065 and 0.4127 kg/m^3
        for alt_m, true in ((1e-4, 20.0), (2000.0, 22.064), (10_000.0, 34.457)):
            vehicle = Vehicle(by_air=True)
            for tenth in range(51, 63):
                turn(vehicle, 0.1 * tenth, yaw=0.5 * math.pi)
                vehicle.hear("VFR_HUD", hud(20.0, alt=alt_m), 0.1 * tenth)
            (north, east), _ = vehicle.seen_at(6.1)
            self.assertAlmostEqual(east, true, delta=0.01)
            self.assertAlmostEqual(north, 0.0)

    def test_are_as_high_for_that_as_altitude_tells(self):
        vehicle = Vehicle(by_air=True)
        vehicle.hear("ALTITUDE", altitude(300.0, 2000.0), 5.0)
        for tenth in range(51, 63):
            turn(vehicle, 0.1 * tenth)
            vehicle.hear("VFR_HUD", hud(20.0, alt=300.0), 0.1 * tenth)
        self.assertAlmostEqual(vehicle.seen_at(6.1)[0][0], 22.06, places=2)

    def test_are_as_fast_as_nobody_knows_where_their_height_or_airspeed_is_not_known(self):
        for fields in (hud(20.0, alt=math.nan), hud(20.0, alt=0.0), hud(20.0, alt=11_001.0), hud(math.nan), hud(math.inf)):
            vehicle = Vehicle(by_air=True)
            for tenth in range(50, 62):
                turn(vehicle, 0.1 * tenth)
                vehicle.hear("VFR_HUD", fields, 0.1 * tenth)
            self.assertIsNone(vehicle.seen_at(6.0)[0])

    def test_do_not_go_where_the_nose_pointed_long_ago(self):
        for late_s, holes in ((0.29, 0), (0.31, 1)):
            vehicle = Vehicle(by_air=True)
            for came, after_s in ((5.0, 0.0), (6.5, late_s), (8.0, 0.0)):
                turn(vehicle, came)
                vehicle.hear("VFR_HUD", hud(20.0), came + after_s)
            self.assertEqual(vehicle.holes_before(8.0), holes)


if __name__ == "__main__":
    unittest.main()
