#include "core/detect/attitude.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/frame_camera.hpp"

namespace roadfix {

cv::Matx33d rotation_of(const Attitude& attitude) {
  FrameCamera camera;
  camera.pitch = attitude.pitch;
  camera.roll = attitude.roll;
  const double c = cos(attitude.yaw);
  const double s = sin(attitude.yaw);
  return cv::Matx33d(c, -s, 0, s, c, 0, 0, 0, 1) * level_from_camera(camera);
}

Attitude attitude_of(const cv::Matx33d& rotation) {
  return {Angle::radians(std::atan2(-rotation(0, 1), rotation(1, 1))),
          Angle::radians(std::asin(std::clamp(rotation(2, 1), -1.0, 1.0))),
          Angle::radians(std::atan2(rotation(2, 0), rotation(2, 2)))};
}

Attitude mounted(const Attitude& carrier, const Attitude& mount) {
  return attitude_of(rotation_of(carrier) * rotation_of(mount));
}

}  // namespace roadfix
