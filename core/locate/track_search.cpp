#include "core/locate/track_search.hpp"

#include <algorithm>

#include "core/locate/other_places.hpp"

namespace roadfix {
namespace {

constexpr double kUntoldScaleRange = 0.15;  // tried before a fix is believed, though the altitude is said to be exact

}  // namespace

std::optional<Fix> TrackSearch::find(const FeatureMap& features, const Prior& prior, FixOptions options,
                                     double time_share) const {
  if (settings_.max_search_km2 && region_of(map_, prior).area_km2() > *settings_.max_search_km2) return std::nullopt;
  options.search.threads = limits_.threads;
  options.search.deadline = limits_.deadline.after(time_share);
  options.calibration = settings_.calibration;
  return locate(map_, features, prior, options);
}

bool TrackSearch::holds_at_other_scales(const Fix& fix, const FeatureMap& features, const Prior& prior) const {
  constexpr double kTimeShare = 0.5;
  if (settings_.vehicle.scale_range >= kUntoldScaleRange) return true;
  if (const auto holds = has_no_rival(fix, features, prior, kTimeShare)) return *holds;
  Prior around;
  around.circle = GeoCircle{fix.modes.front().pose.position, kAroundM};
  return has_no_rival(fix, features, around, 1.0).value_or(false);
}

std::optional<bool> TrackSearch::has_no_rival(const Fix& fix, const FeatureMap& features, const Prior& prior,
                                              double time_share) const {
  constexpr double kMaxRivalShare = 0.3;  // of the weight of the place
  const std::optional<Fix> other =
      find(features, prior, {.looks_beyond_prior = false, .search = {.scale_range = kUntoldScaleRange}}, time_share);
  if (!other || !other->complete) return std::nullopt;
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
