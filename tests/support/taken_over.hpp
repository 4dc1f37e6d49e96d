// What a camera takes of a flat picture of the ground.
#pragma once

#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/detect/frame_camera.hpp"
#include "core/detect/orthoimage.hpp"
#include "core/grid/relief.hpp"
#include "core/units/planar.hpp"

namespace roadfix::testing {

/// From above a place of the plane, on ground of that relief; black beyond the picture.
inline cv::Mat taken_over(const Orthoimage& ground, const GridPose& pose, const FrameCamera& camera, cv::Size size,
                          const std::optional<Relief>& relief = {}) {
  const Lens lens = lens_of(camera, size);
  cv::Mat places(size, CV_32FC2);
  for (int row = 0; row < size.height; ++row) {
    for (int col = 0; col < size.width; ++col) {
      cv::Point2d at = ground_of(camera, lens.ray_of({col + 0.5, row + 0.5}).value()).value();
      if (relief) at /= relief->stretch_at(at.x, at.y);
      const GridPoint on_plane = moved(pose, {-at.y, at.x, {}}).position;
      places.at<cv::Point2f>(row, col) =
          cv::Point2d((on_plane.east_m - ground.north_west.east_m) / ground.image.gsd_m - 0.5,
                      (ground.north_west.north_m - on_plane.north_m) / ground.image.gsd_m - 0.5);
    }
  }
  cv::Mat frame;
  cv::remap(ground.image.pixels, frame, places, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return frame;
}

}  // namespace roadfix::testing
