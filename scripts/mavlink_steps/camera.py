"""Which way a camera looks down: roll, pitch and yaw in radians, aerospace convention, of an airframe to whose floor it
would be fixed, the upper edge of its picture ahead."""
import math


def _angles(forward, right_down, down_down):
    """Of axes in ones that are level: that ahead, and how far those to the right and down point down."""
    return (math.atan2(right_down, down_down), math.asin(max(-1.0, min(1.0, -forward[2]))),
            math.atan2(forward[1], forward[0]))


def turned(attitude, yaw):
    """Of a camera that is turned in such an airframe about its downward axis, clockwise seen from above."""
    roll, pitch, heading = attitude
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
    cy, sy = math.cos(yaw), math.sin(yaw)
    # Forward and right of the camera in axes that are level and point to the heading; down stays as it is.
    forward = (cy * cp + sy * sr * sp, sy * cr, -cy * sp + sy * sr * cp)
    right_down = sy * sp + cy * sr * cp
    camera_roll, camera_pitch, camera_yaw = _angles(forward, right_down, cr * cp)
    return camera_roll, camera_pitch, heading + camera_yaw


def in_gimbal(quaternion, heading):
    """Of one that looks ahead where the quaternion (w, x, y, z) is (1, 0, 0, 0), in axes that are level and point to
    the heading."""
    w, x, y, z = quaternion
    up = (-2.0 * (x * z + w * y), -2.0 * (y * z - w * x), 2.0 * (x * x + y * y) - 1.0)  # the picture's upper edge
    roll, pitch, yaw = _angles(up, 2.0 * (y * z + w * x), 2.0 * (x * z - w * y))
    return roll, pitch, heading + yaw
