#!/usr/bin/python3
"""Which way cameras look: against rotation matrices, and quaternions that were worked out by hand."""
import math
import random
import sys
import unittest
from pathlib import Path

from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from camera import in_gimbal, lean, turned  # noqa: E402
from gimbal import STATUS, Gimbal  # noqa: E402
from history import Unknown  # noqa: E402
from packets import Message  # noqa: E402

HALF = math.sqrt(0.5)
DOWN = (HALF, 0.0, -HALF, 0.0)            # pitch -90
DOWN_TO_THE_EAST = (0.5, 0.5, -0.5, 0.5)  # (HALF, 0, 0, HALF) * DOWN: yaw 90, pitch -90
AHEAD_AND_DOWN = (math.cos(math.radians(30.0)), 0.0, -math.sin(math.radians(30.0)), 0.0)  # pitch -60
VEHICLE, EARTH, LOCK = 32, 64, 16
ROLL_AND_PITCH_LOCK = 12


def about(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return {0: ((1, 0, 0), (0, c, -s), (0, s, c)), 1: ((c, 0, s), (0, 1, 0), (-s, 0, c)),
            2: ((c, -s, 0), (s, c, 0), (0, 0, 1))}[axis]


def product(*matrices):
    result, *others = matrices
    for other in others:
        result = tuple(tuple(sum(a * b for a, b in zip(row, column)) for column in zip(*other)) for row in result)
    return result


def rotation(roll, pitch, yaw):
    return product(about(2, yaw), about(1, pitch), about(0, roll))


def degrees(angles):
    return [round(math.degrees(angle), 6) for angle in angles]


def status(quaternion, came, flags=VEHICLE, delta_yaw=0.0, component=154, device=0):
    """Seconds since its start are those of ours less 90."""
    fields = {"time_boot_ms": round(1e3 * (came - 90.0)), "flags": flags | ROLL_AND_PITCH_LOCK, "delta_yaw": delta_yaw,
              "gimbal_device_id": device, **dict(zip(("qw", "qx", "qy", "qz"), quaternion))}
    return Message(7, component, STATUS, fields)


def heard(*messages, device=None):
    """Each (quaternion, came, ...) as for status()."""
    gimbal = Gimbal(device)
    with said():
        for message in messages:
            gimbal.hear(status(*message), message[1])
    return gimbal


def ground_of(roll, pitch, yaw, right, back):
    """How far to the north and east of a vehicle 1 m above ground a ray of core/detect/frame_camera.cpp ends, by its
    matrices: axes right, back and down, level = pitch * roll."""
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
    level = product(((1, 0, 0), (0, cp, -sp), (0, sp, cp)), ((cr, 0, -sr), (0, 1, 0), (sr, 0, cr)),
                    ((right,), (back,), (1.0,)))
    right_m, ahead_m = level[0][0] / level[2][0], -level[1][0] / level[2][0]
    return (math.cos(yaw) * ahead_m - math.sin(yaw) * right_m, math.sin(yaw) * ahead_m + math.cos(yaw) * right_m)


class Cameras(unittest.TestCase):
    def assert_matrices_alike(self, actual, expected):
        for row, other in zip(actual, expected):
            for a, b in zip(row, other):
                self.assertAlmostEqual(a, b, places=9)

    def test_that_are_turned_in_the_airframe_have_the_attitude_of_both_rotations(self):
        draw = random.Random(3)
        for _ in range(300):
            attitude = (draw.uniform(-1.4, 1.4), draw.uniform(-1.4, 1.4), draw.uniform(-9, 9))
            mount = (draw.uniform(-1.4, 1.4), draw.uniform(-1.4, 1.4), draw.uniform(-4, 4))
            self.assert_matrices_alike(rotation(*turned(attitude, mount)),
                                       product(rotation(*attitude), rotation(*mount)))

    def test_that_are_turned_in_the_airframe_see_the_ground_that_their_rays_meet_by_the_service_s_matrices(self):
        draw = random.Random(4)
        for _ in range(300):
            attitude = (draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3), draw.uniform(-4, 4))
            mount = (draw.uniform(-0.5, 0.5), draw.uniform(-0.5, 0.5), draw.uniform(-4, 4))
            right, back = draw.uniform(-0.2, 0.2), draw.uniform(-0.2, 0.2)
            north, east, down = (row[0] for row in product(rotation(*attitude), rotation(*mount),
                                                           ((-back,), (right,), (1.0,))))
            expected = (north / down, east / down)
            for a, b in zip(ground_of(*turned(attitude, mount), right, back), expected):
                self.assertAlmostEqual(a, b, places=9)

    def test_that_are_turned_in_the_airframe_look_ahead_left_and_to_where_their_upper_edge_points(self):
        ten, thirty, right_angle = map(math.radians, (10, 30, 90))
        for attitude, mount, (north, east) in (
                ((0, 0, 0), (0, thirty, 0), (math.tan(thirty), 0)),
                ((0, 0, right_angle), (0, thirty, 0), (0, math.tan(thirty))),
                ((0, 0, 0), (ten, 0, 0), (0, -math.tan(ten))),
                ((0, 0, 0), (0, thirty, right_angle), (0, math.tan(thirty))),
                ((0, 0, 0), (ten, 0, right_angle), (math.tan(ten), 0)),
                ((0, ten, 0), (0, thirty, 0), (math.tan(ten + thirty), 0)),
                ((-ten, 0, 0), (0, thirty, right_angle), (0, math.tan(ten + thirty)))):
            seen = ground_of(*turned(attitude, mount), 0.0, 0.0)
            self.assertAlmostEqual(seen[0], north, places=9)
            self.assertAlmostEqual(seen[1], east, places=9)

    def test_lean_as_far_as_their_optical_axis_is_from_straight_down(self):
        draw = random.Random(6)
        for _ in range(100):
            roll, pitch = draw.uniform(-1.5, 1.5), draw.uniform(-1.5, 1.5)
            north, east = ground_of(roll, pitch, 0.0, 0.0, 0.0)
            self.assertAlmostEqual(lean(roll, pitch), math.atan(math.hypot(north, east)), places=9)
        self.assertAlmostEqual(lean(math.pi, 0.0), math.pi)

    def test_in_gimbals_look_where_quaternions_turn_one_that_looks_ahead(self):
        draw = random.Random(5)
        for _ in range(300):
            roll, pitch, yaw = draw.uniform(-1.5, 1.5), draw.uniform(-1.7, 0.0), draw.uniform(-3, 3)
            cr, sr, cp, sp = math.cos(roll / 2), math.sin(roll / 2), math.cos(pitch / 2), math.sin(pitch / 2)
            cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
            quaternion = (cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                          cr * cp * sy - sr * sp * cy)
            heading = draw.uniform(-4, 4)
            expected = product(about(2, heading), rotation(roll, pitch, yaw), about(1, 0.5 * math.pi))
            self.assert_matrices_alike(rotation(*in_gimbal(quaternion, heading)), expected)

    def test_in_gimbals_have_the_angles_that_quaternions_worked_out_by_hand_say(self):
        for quaternion, angles in ((DOWN, (0, 0, 10)), (DOWN_TO_THE_EAST, (0, 0, 100)), (AHEAD_AND_DOWN, (0, 30, 10)),
                                   ((math.cos(math.radians(50)), 0, -math.sin(math.radians(50)), 0), (0, -10, 10))):
            self.assertEqual(degrees(in_gimbal(quaternion, math.radians(10))), list(angles))


class Gimbals(unittest.TestCase):
    def test_tell_their_yaw_from_the_nose_or_from_north_as_their_flags_say(self):
        for flags, yaw_deg in ((VEHICLE, 130), (EARTH, 90), (VEHICLE | LOCK, 130), (EARTH | LOCK, 90), (LOCK, 90),
                               (0, 130)):
            gimbal = heard((DOWN_TO_THE_EAST, 100.0, flags), (DOWN_TO_THE_EAST, 100.2, flags))
            self.assertEqual(degrees(gimbal.camera_at(100.1, math.radians(40))), [0, 0, yaw_deg], flags)

    def test_that_turn_by_another_heading_than_the_autopilots_are_as_far_from_its_nose_as_from_theirs(self):
        for flags, delta_deg, yaw_deg in ((EARTH, 30, 40 + 90 - 30), (EARTH, -80, 40 + 90 + 80), (EARTH, math.nan, 90),
                                          (EARTH, 0, 90), (VEHICLE, 30, 130), (LOCK, 30, 90), (0, 30, 130)):
            gimbal = heard(*((DOWN_TO_THE_EAST, came, flags, math.radians(delta_deg)) for came in (100.0, 100.2)))
            self.assertEqual(degrees(gimbal.camera_at(100.1, math.radians(40))), [0, 0, yaw_deg], (flags, delta_deg))

    def test_that_move_are_between_what_they_told_whatever_the_sign_of_their_quaternions(self):
        for sign in (1.0, -1.0):
            gimbal = heard((DOWN, 100.0), (tuple(sign * part for part in AHEAD_AND_DOWN), 100.4))
            for when, pitch_deg in ((100.0, 0), (100.2, 15), (100.4, 30)):
                self.assertEqual(degrees(gimbal.camera_at(when, 0.0)), [0, pitch_deg, 0])

    def test_look_nobody_knows_where_when_nothing_of_that_time_was_heard(self):
        unheard, late = heard(), heard((DOWN, 100.0), (DOWN, 100.61), (DOWN, 100.8))
        turned_over = heard((DOWN, 100.0), (DOWN, 100.2), (DOWN, 100.4, EARTH), (DOWN, 100.6, EARTH))
        for gimbal, when in ((unheard, 100.0), (late, 99.9), (late, 100.3), (late, 100.81), (turned_over, 100.1),
                             (turned_over, 100.3)):
            with self.assertRaisesRegex(Unknown, "no two GIMBAL_DEVICE_ATTITUDE_STATUS around that time"):
                gimbal.camera_at(when, 0.0)
        self.assertEqual(degrees(late.camera_at(100.7, 0.0)), [0, 0, 0])
        self.assertEqual(degrees(turned_over.camera_at(100.5, 1.0)), [0, 0, 0])
        self.assertEqual([late.knows(when) for when in (100.8, 100.81)], [True, False])
        self.assertFalse(unheard.knows(100.0))

    def test_do_not_look_where_quaternions_say_that_are_none_or_come_late(self):
        for quaternion in ((0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 0.0), (1.0, math.inf, 0.0, 0.0)):
            gimbal = heard((DOWN, 100.0), (quaternion, 100.1), (DOWN, 100.2))
            self.assertEqual(degrees(gimbal.camera_at(100.1, 0.0)), [0, 0, 0])
        gimbal = heard((DOWN, 100.0), (DOWN, 101.9), (DOWN, 102.1))
        gimbal.hear(status(AHEAD_AND_DOWN, 100.0), 102.2)
        self.assertEqual(degrees(gimbal.camera_at(102.0, 0.0)), [0, 0, 0])

    def test_are_told_from_others_of_the_vehicle(self):
        for device, taken, words in ((None, 0, ["listening to gimbal 154", "gimbal 2 is ignored (--gimbal)"]),
                                     (2, 30, ["gimbal 154 is ignored (--gimbal)"]),
                                     (1, None, ["gimbal 154 is ignored (--gimbal)", "gimbal 2 is ignored (--gimbal)"])):
            gimbal = Gimbal(device)
            with said() as text:
                for came in (100.0, 100.2):
                    gimbal.hear(status(DOWN, came), came)
                    gimbal.hear(status(AHEAD_AND_DOWN, came, component=1, device=2), came)
            self.assertEqual(text.getvalue().splitlines(), words)
            self.assertEqual(gimbal.knows(100.2), taken is not None)
            if taken is not None:
                self.assertEqual(degrees(gimbal.camera_at(100.1, 0.0)), [0, taken, 0])


if __name__ == "__main__":
    unittest.main()
