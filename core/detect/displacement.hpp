// Where a frame is found whose camera looked another way than was told.
#pragma once

#include <complex>
#include <opencv2/core.hpp>
#include <vector>

#include "core/detect/attitude.hpp"
#include "core/detect/frame_camera.hpp"
#include "core/units/planar.hpp"

namespace roadfix {

struct Displacement {
  BodyOffset offset;  ///< of the pose that is found, from the true place and the told heading
  double size = 1.0;  ///< in which what the frame shows is found, of that in which it was rectified
};

/// What a frame shows, placed on the ground as is told of its camera.
class PlacedFrame {
 public:
  /// `told` is validated, and the frame shows ground.
  PlacedFrame(const FrameCamera& told, cv::Size frame);

  /// If the camera had another attitude (its yaw clockwise from the told heading) and was `higher` times as high: the
  /// similarity that lays what was placed where it is, by least squares over pixels all over the frame that see ground
  /// which is looked at (farthest_ground_m()).
  Displacement seen_by(const Attitude& actual, double higher) const;

 private:
  using Ground = std::complex<double>;  // right of the nadir + i back of it, metres

  void place(const FrameCamera& told, cv::Size frame, double farthest_m);

  double agl_m_;
  std::vector<cv::Vec3d> rays_;
  std::vector<Ground> placed_;  ///< by ray, from their mean
  Ground mean_;
};

}  // namespace roadfix
