// From a camera frame to the ground it shows: a metric picture in the body frame.
#pragma once

#include <opencv2/core.hpp>

#include "core/detect/frame_camera.hpp"
#include "core/detect/road_detector.hpp"

namespace roadfix {

struct GroundView {
  GroundImage image;
  cv::Point2d nadir_px;  ///< the point below the UAV in continuous pixels ((0, 0) = outer corner), may lie outside
  double nadir_sigma_m = 0.0;  ///< see FeatureMap
  Angle nadir_heading_sigma{};
};

/// How finely the ground is shown, and how much of it.
struct RectifiedGround {
  double gsd_m = 1.0;
  double max_range_m = 0.0;  ///< from the nadir point; beyond it a tilted view is all blur
  double max_pixels = 0.0;   ///< LimitExceeded ("ground-too-large") for more
};

/// The ground that the frame shows; pixels outside the frame are unobserved. A frame of finer pixels is averaged.
/// `frame_observed` (CV_8UC1, empty = all) marks the frame's observed pixels. Throws what validate(),
/// require_looking_down() and lens_of() do, LimitExceeded ("ground-too-large", and "image-too-large" for a frame that
/// is too long to be warped) and InvalidInput ("frame-sees-no-ground").
GroundView rectify(const cv::Mat& frame, const cv::Mat& frame_observed, const FrameCamera& camera,
                   const RectifiedGround& ground);

}  // namespace roadfix
