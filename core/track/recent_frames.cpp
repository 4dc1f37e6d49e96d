#include "core/track/recent_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roadfix {
namespace {

using Frame = RecentFrames::Frame;

constexpr double kMaxCombinedCells = 16e6;  // more than frames make that may be kept

double slip_m(const Frame& frame) {
  const double arm = 0.5 * frame.placed.features.side_m();
  return std::sqrt(frame.position_m2 + arm * arm * frame.turn_rad2);
}

bool is_near_enough(const Frame& frame) {
  return slip_m(frame) <= RecentFrames::kMaxSlipM &&
         distance_m(frame.placed.offset) <= RecentFrames::kMaxSides * frame.placed.features.side_m();
}

bool is_small_enough(const FeatureMap& features) {
  return std::max(features.cells.cols(), features.cells.rows()) <= RecentFrames::kMaxAcross &&
         features.off_nadir_cells() <= RecentFrames::kMaxAcross;
}

/// The same place from where the vehicle is after `step`.
BodyOffset seen_after(const Odometry& step, const BodyOffset& before) {
  return offset_from(moved({}, step), moved({}, before));
}

}  // namespace

bool RecentFrames::may_keep(const Frame& frame) {
  return is_small_enough(frame.placed.features) && is_near_enough(frame);
}

void RecentFrames::move(const Odometry& odometry, const OdometryCovariance& covariance) {
  for (Frame& frame : frames_) {
    BodyOffset& offset = frame.placed.offset;
    offset = seen_after(odometry, offset);
    const double arm = distance_m(offset);
    frame.position_m2 += largest_variance_m2(covariance) + arm * arm * covariance[2][2];
    frame.turn_rad2 += covariance[2][2];
  }
  std::erase_if(frames_, [](const Frame& frame) { return !is_near_enough(frame); });
}

void RecentFrames::keep(const FeatureMap& features) {
  static_assert(kMaxCells >= std::size_t{kMaxAcross} * kMaxAcross, "the newest frame is kept, however large it may be");
  if (!is_small_enough(features)) return;
  if (!frames_.empty() && frames_.front().placed.features.cell_m != features.cell_m) frames_.clear();
  const double apart_m = kApartShare * features.cell_m * std::min(features.cells.cols(), features.cells.rows());
  const auto shows_the_same = [&](const Frame& kept) { return distance_m(kept.placed.offset) < apart_m; };
  if (std::ranges::any_of(frames_, shows_the_same)) return;
  frames_.push_back({{features, {}}, 0.0, 0.0});
  std::size_t sum = 0;
  std::size_t count = 0;
  for (auto frame = frames_.rbegin(); frame != frames_.rend() && count < kMaxFrames; ++frame, ++count) {
    sum += frame->placed.features.cells.cells().size();
    if (sum > kMaxCells) break;
  }
  frames_.erase(frames_.begin(), frames_.end() - static_cast<std::ptrdiff_t>(count));
}

FeatureMap RecentFrames::laid_around(const FeatureMap& features) const {
  if (!is_small_enough(features)) return features;
  std::vector<PlacedFeatures> parts{{features, {}}};
  for (const Frame& frame : frames_) {
    if (frame.placed.features.cell_m == features.cell_m) parts.push_back(frame.placed);
  }
  return parts.size() == 1 ? features : combined(parts, kMaxCombinedCells);
}

}  // namespace roadfix
