#include "core/locate/track_search.hpp"

#include <algorithm>
#include <chrono>

#include "core/locate/track_geometry.hpp"
#include "core/units/error.hpp"

namespace roadfix {

std::optional<Fix> TrackSearch::find(const FeatureMap& features, const Prior& prior, FixOptions options) const {
  options.max_search_km2 = settings_.max_search_km2;
  options.threads = limits_.threads;
  if (limits_.searches_end) {
    const auto left = *limits_.searches_end - std::chrono::steady_clock::now();
    options.time_limit = std::max(std::chrono::ceil<std::chrono::milliseconds>(left), std::chrono::milliseconds(0));
  }
  options.stop = limits_.stop;
  options.calibration = settings_.calibration;
  try {
    return locate(map_, features, prior, options);
  } catch (const LimitExceeded&) {
    return std::nullopt;
  }
}

bool TrackSearch::holds_at_other_scales(const Fix& fix, const FeatureMap& features, const Prior& prior) const {
  constexpr double kUntoldScaleRange = 0.15;  // of altitudes that are taken for exact, before a fix is believed
  constexpr double kMaxRivalShare = 0.3;      // of the weight of the place
  if (settings_.vehicle.scale_range >= kUntoldScaleRange) return true;
  const std::optional<Fix> other =
      find(features, prior, {.scale_range = kUntoldScaleRange, .looks_beyond_prior = false});
  if (!other || !other->complete) return false;
  const GridPose place = on_grid(fix.modes.front().pose, map_.zone);
  double here = 0.0;
  double elsewhere = 0.0;
  for (const FixMode& mode : other->modes) {
    double& weight = is_same_place(on_grid(mode.pose, map_.zone), place) ? here : elsewhere;
    weight = std::max(weight, mode.weight);
  }
  return elsewhere < kMaxRivalShare * here;
}

}  // namespace roadfix
