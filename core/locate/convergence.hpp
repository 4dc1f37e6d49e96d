// Whether a step may claim the place that its track believes in (docs/tracks.md, "When a place is claimed").
#pragma once

#include "core/filter/clusters.hpp"
#include "core/locate/tracker.hpp"

namespace roadfix {

/// `state` after the step; `best`: the heaviest cluster of its particles; `doubt`: that of its filter.
bool has_converged(const TrackSettings& settings, const TrackerState& state, const Cluster& best,
                   Measurement measurement, double doubt);

}  // namespace roadfix
