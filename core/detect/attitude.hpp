// Attitudes as rotations, and what comes out where a camera is mounted askew.
#pragma once

#include <opencv2/core.hpp>

#include "core/units/angle.hpp"

namespace roadfix {

/// Of a camera or an airframe: turned about its axes by yaw (clockwise from north, seen from above), then pitch, then
/// roll, as FrameCamera has the latter two. As a mount: of a camera in the axes of what carries it.
struct Attitude {
  Angle yaw;
  Angle pitch;
  Angle roll;
};

/// From the axes of the camera (x right, y back, z down the optical axis) to level ones that point north.
cv::Matx33d rotation_of(const Attitude& attitude);
/// And back: yaw and roll in (-180, 180], pitch in [-90, 90] degrees.
Attitude attitude_of(const cv::Matx33d& rotation);

/// Of a camera in what has the attitude `carrier`.
Attitude mounted(const Attitude& carrier, const Attitude& mount);

}  // namespace roadfix
