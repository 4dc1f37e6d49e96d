// The searches of a track: fixes within the area that the track may search and the time that the step may take.
// Stateless: the step decides what follows from them.
#pragma once

#include <optional>

#include "core/locate/altitude.hpp"
#include "core/track/step_limits.hpp"
#include "core/track/track_settings.hpp"

namespace roadfix {

class TrackSearch {
 public:
  /// All outlive it.
  TrackSearch(const MapView& map, const TrackSettings& settings, const StepLimits& limits)
      : map_(map), settings_(settings), limits_(limits) {}

  /// From now on feature maps were seen from there.
  void see_from(const Altitude& altitude) { altitude_ = altitude; }

  /// locate_from() with the area, threads and calibration of the track in place of those in `options`, within a share
  /// of the time that the step has left; over ground whose heights allow too many sizes, all that a search can go over
  /// from above the believed place. nullopt where the area is beyond the limit.
  std::optional<Fix> find(const FeatureMap& features, const Prior& prior, FixOptions options,
                          double time_share = 1.0) const;

  /// Whether the best place of `fix`, found for `features`, has no rival even if the scale of `features` is wrong:
  /// within `prior` or, if that takes more than half of the remaining time, within kAroundM of the place. From a wrong
  /// altitude the streets of one quarter look like those of another with smaller blocks, and no later frame contradicts
  /// that. The place itself at another scale is a rival, too: matched at a wrong one, it is less accurate than stated.
  bool holds_at_other_scales(const Fix& fix, const FeatureMap& features, const Prior& prior) const;

  /// Radius of the circle that is searched where the whole map is too large, or takes too long.
  static constexpr double kAroundM = 3000.0;

 private:
  /// nullopt where the search does not end in its share of the time.
  std::optional<bool> has_no_rival(const Fix& fix, const FeatureMap& features, const Prior& prior,
                                   double time_share) const;

  const MapView& map_;
  const TrackSettings& settings_;
  const StepLimits& limits_;
  std::optional<Altitude> altitude_;
};

}  // namespace roadfix
