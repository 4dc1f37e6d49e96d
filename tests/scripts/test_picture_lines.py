#!/usr/bin/python3
"""Lines of pictures: what the autopilot told of the time at which each was taken."""
import contextlib
import io
import json
import math
import sys
import types
import unittest
from pathlib import Path

from fake_time import FakeTime
from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from clock import WallClock  # noqa: E402
from gimbal import STATUS, Gimbal  # noqa: E402
from lines import Lines  # noqa: E402
from packets import Message  # noqa: E402
from vehicle import Vehicle  # noqa: E402


class LinesOfPictures(unittest.TestCase):
    """Of a flight to the north at 10 m/s."""

    def setUp(self):
        self.time = FakeTime()
        self.time.__enter__()
        self.addCleanup(self.time.__exit__)
        self.vehicle = Vehicle()
        self.clock = WallClock()
        self.options = types.SimpleNamespace(camera="level", camera_yaw=0.0, camera_pitch=0.0, camera_roll=0.0,
                                             agl=100.0, by_terrain=False, delay=0.0, origin="o")
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

    def test_tell_headings_from_0_to_360_degrees_after_any_turn(self):
        for yaw in (2.0, -2.5, -0.5, 0.5):
            self.fly(2.0, yaw=yaw)
        self.lines.add("1.jpg", self.time.now - 0.05)
        ((step,), _) = self.printed()
        self.assertAlmostEqual(step["yaw_deg"], math.degrees(0.5), places=2)

    def test_tell_how_the_camera_leans(self):
        for camera, roll, pitch in (("level", 0.0, 0.0), ("body", 0.2, 0.1)):
            self.options.camera = camera
            self.fly(3.0, roll=0.2)
            self.lines.add("1.jpg", self.time.now - 0.05)
            ((step,), _) = self.printed()
            self.assertAlmostEqual(step["roll_deg"], math.degrees(roll), places=2)
            self.assertAlmostEqual(step["pitch_deg"], math.degrees(pitch), places=2)

    def test_tell_how_a_camera_leans_that_is_mounted_so(self):
        self.options.camera_pitch, self.options.camera_roll = 30.0, -2.0
        for camera, camera_yaw, roll_deg, pitch_deg, yaw_deg in (
                ("level", 90.0, -2.0, 30.0, 90.0), ("body", 0.0, -2.0, 30.0 + math.degrees(0.1), 0.0),
                ("body", 180.0, -2.0, 30.0 - math.degrees(0.1), 180.0)):
            self.options.camera, self.options.camera_yaw = camera, camera_yaw
            self.fly(3.0)
            self.lines.add("1.jpg", self.time.now - 0.05)
            ((step,), _) = self.printed()
            self.assertAlmostEqual(step["roll_deg"], roll_deg, places=2)
            self.assertAlmostEqual(step["pitch_deg"], pitch_deg, places=2)
            self.assertAlmostEqual(abs(step["camera_yaw_deg"]), yaw_deg, places=2)

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

    def test_tell_the_height_above_the_sea_alone_where_the_map_knows_the_ground(self):
        self.options.agl, self.options.by_terrain = None, True
        self.fly(1.0)
        self.lines.add("1.jpg", self.time.now - 0.05)
        self.assertEqual(self.printed(), ([], "1.jpg is left out: no height above the sea (ALTITUDE or VFR_HUD): ask "
                                              "the autopilot for one of them (SET_MESSAGE_INTERVAL)\n"))
        self.vehicle.hear("VFR_HUD", {"alt": 640.5, "airspeed": 10.0}, self.time.now)
        self.fly(1.0)
        self.lines.add("2.jpg", self.time.now - 0.05)
        (step,), _ = self.printed()
        self.assertEqual(step["alt_m"], 640.5)
        self.assertNotIn("agl_m", step)

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
