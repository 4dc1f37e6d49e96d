#include "core/track/track_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/locate/other_places.hpp"

namespace roadfix {
namespace {

constexpr double kUntoldScaleRange = 0.15;  // tried before a fix is believed, though the altitude is said to be exact

/// Whether a mode of a search over scales bears the fix out: it lies there, and at that size of the ground. Otherwise
/// the streets at the rim of what was seen, 150 m off, are farther from those of the map than two of the standard
/// deviations that fixes state, and the place may be off by as much. Altitudes that are measured err by less.
bool agrees(const FixMode& mode, const FixMode& fixed, const UtmZone& zone) {
  constexpr double kSameSize = 0.05;
  return is_same_place(on_grid(mode.pose, zone), on_grid(fixed.pose, zone)) &&
         std::abs(std::log(mode.scale / fixed.scale)) <= kSameSize;
}

}  // namespace

std::optional<Fix> TrackSearch::find(const FeatureMap& features, const Prior& prior, FixOptions options,
                                     double time_share) const {
  if (settings_.max_search_km2 && region_of(map_, prior).area_km2() > *settings_.max_search_km2) return std::nullopt;
  options.search.threads = limits_.threads;
  options.search.deadline = limits_.deadline.after(time_share);
  options.calibration = settings_.calibration;
  Fix fix = locate_from(altitude_, map_, features, prior, options);
  if (fix.reason != kHeightUnknown) return fix;
  options.search.scale_range = kMaxScaleRange;
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
  double agreeing = 0.0;
  double rival = 0.0;
  for (const FixMode& mode : other->modes) {
    double& weight = agrees(mode, fix.modes.front(), map_.zone) ? agreeing : rival;
    weight = std::max(weight, mode.weight);
  }
  return rival < kMaxRivalShare * agreeing;
}

}  // namespace roadfix
