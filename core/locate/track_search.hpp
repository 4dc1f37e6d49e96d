// The searches of a track: fixes within what the track may search and the step may take. Stateless: what a search found
// becomes of the track is up to its step.
#pragma once

#include <optional>

#include "core/locate/fix.hpp"
#include "core/locate/step_limits.hpp"
#include "core/locate/track_settings.hpp"

namespace roadfix {

class TrackSearch {
 public:
  /// All outlive it.
  TrackSearch(const MapView& map, const TrackSettings& settings, const StepLimits& limits)
      : map_(map), settings_(settings), limits_(limits) {}

  /// locate() with the area, threads and calibration of the track in place of those in `options`, within a share of the
  /// time that the step has left. nullopt where the area is beyond the limit.
  std::optional<Fix> find(const FeatureMap& features, const Prior& prior, FixOptions options,
                          double time_share = 1.0) const;

  /// Whether the best place of `fix`, found for `features`, has no rival where the ground may be of another size than
  /// they say: within `prior`, or where that outlasts half of the time that is left, within kAroundM of the place. From
  /// a wrong altitude the streets of one quarter look like those of another whose blocks are as much smaller, and no
  /// frame contradicts it.
  bool holds_at_other_scales(const Fix& fix, const FeatureMap& features, const Prior& prior) const;

  /// Of the circle that is searched where the whole map is too much, or takes too long.
  static constexpr double kAroundM = 3000.0;

 private:
  /// nullopt where the search does not end in its share of the time.
  std::optional<bool> has_no_rival(const Fix& fix, const FeatureMap& features, const Prior& prior,
                                   double time_share) const;

  const MapView& map_;
  const TrackSettings& settings_;
  const StepLimits& limits_;
};

}  // namespace roadfix
