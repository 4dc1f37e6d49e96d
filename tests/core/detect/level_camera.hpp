// A camera for tests of frames that looks straight down.
#pragma once

#include <opencv2/core.hpp>

#include "core/detect/frame_camera.hpp"

namespace roadfix::testing {

inline const cv::Size kFrame(640, 480);

/// 100 m above ground; frames are 200 m wide.
inline FrameCamera level_camera() {
  FrameCamera camera;
  camera.horizontal_fov = Angle::degrees(90);
  camera.agl_m = 100;
  return camera;
}

}  // namespace roadfix::testing
