// Whether a step may claim the place that its track believes in (docs/tracks.md, "When a place is claimed").
#pragma once

#include <optional>

#include "core/filter/clusters.hpp"
#include "core/track/track_estimate.hpp"
#include "core/track/tracker.hpp"

namespace roadfix {

/// nullopt if it may. `state` after the step; `best`: the heaviest cluster of its particles; `doubt`: that of its
/// filter.
std::optional<Unclaimed> why_unclaimed(const TrackSettings& settings, const TrackerState& state, const Cluster& best,
                                       Measurement measurement, double doubt);

}  // namespace roadfix
