#include "core/detect/displacement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/detect/frame.hpp"
#include "core/detect/lens.hpp"

namespace roadfix {

PlacedFrame::PlacedFrame(const FrameCamera& told, cv::Size frame) : agl_m_(told.agl_m) {
  place(told, frame, farthest_ground_m(told));
  if (placed_.empty()) place(told, frame, std::numeric_limits<double>::max());  // a corner of it is nearer
  mean_ = std::accumulate(placed_.begin(), placed_.end(), Ground()) / static_cast<double>(placed_.size());
  for (Ground& at : placed_) at -= mean_;
}

void PlacedFrame::place(const FrameCamera& told, cv::Size frame, double farthest_m) {
  constexpr int kSteps = 10;
  const Lens lens = lens_of(told, frame);
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const auto ray =
          lens.ray_of({frame.width * i / static_cast<double>(kSteps), frame.height * j / static_cast<double>(kSteps)});
      const auto ground = ray ? ground_of(told, *ray) : std::nullopt;
      if (!ground || cv::norm(*ground) > farthest_m) continue;
      rays_.emplace_back(ray->x, ray->y, 1.0);
      placed_.emplace_back(ground->x, ground->y);
    }
  }
}

Displacement PlacedFrame::seen_by(const Attitude& actual, double higher) const {
  constexpr double kFlattest = 0.05;  // of the way down: towards the horizon ground is infinitely far
  const cv::Matx33d level_from_camera = rotation_of(actual);
  Ground is_mean;
  Ground turned;
  double spread = 0.0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const cv::Vec3d level = level_from_camera * rays_[i];
    const Ground is = Ground(level[0], level[1]) * (higher * agl_m_ / std::max(level[2], kFlattest));
    is_mean += is;
    turned += std::conj(placed_[i]) * is;
    spread += std::norm(placed_[i]);
  }
  is_mean /= static_cast<double>(rays_.size());
  turned /= spread;
  const Ground nadir = is_mean - turned * mean_;
  return {{-nadir.imag(), nadir.real(), Angle::radians(std::arg(turned))}, std::abs(turned)};
}

}  // namespace roadfix
