"""Which way a camera looks down: roll, pitch and yaw in radians, aerospace convention, of an airframe to whose floor it
would be fixed, the upper edge of its picture ahead."""
import math

FLATTEST = math.radians(80.0)  # from straight down: the service takes no picture that looks beyond


def _angles(forward, right_down, down_down):
    """Of axes in ones that are level: that ahead, and how far those to the right and down point down."""
    return (math.atan2(right_down, down_down), math.asin(max(-1.0, min(1.0, -forward[2]))),
            math.atan2(forward[1], forward[0]))


def _rotation(roll, pitch, yaw):
    """Its columns are the axes ahead, to the right and down of an airframe of that attitude."""
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
    cy, sy = math.cos(yaw), math.sin(yaw)
    return ((cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
            (-sp, cp * sr, cp * cr))


def turned(attitude, mount):
    """Of a camera in such an airframe that is not fixed straight to its floor, but turned against it: by a yaw about the
    axis that points down (clockwise seen from above), then a pitch about its own right axis, then a roll."""
    roll, pitch, heading = attitude
    body = _rotation(roll, pitch, 0.0)
    forward, right, down = (tuple(sum(a * b for a, b in zip(row, axis)) for row in body)
                            for axis in zip(*_rotation(*mount)))
    camera_roll, camera_pitch, camera_yaw = _angles(forward, right[2], down[2])
    return camera_roll, camera_pitch, heading + camera_yaw


def lean(roll, pitch):
    """How far such a camera looks from straight down."""
    return math.acos(max(-1.0, min(1.0, math.cos(roll) * math.cos(pitch))))


def in_gimbal(quaternion, heading):
    """Of one that looks ahead where the quaternion (w, x, y, z) is (1, 0, 0, 0), in axes that are level and point to
    the heading."""
    w, x, y, z = quaternion
    up = (-2.0 * (x * z + w * y), -2.0 * (y * z - w * x), 2.0 * (x * x + y * y) - 1.0)  # the picture's upper edge
    roll, pitch, yaw = _angles(up, 2.0 * (y * z + w * x), 2.0 * (x * z - w * y))
    return roll, pitch, heading + yaw
