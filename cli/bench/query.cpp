#include "cli/bench/query.hpp"

#include "cli/limits.hpp"
#include "core/locate/levelled_fix.hpp"

namespace roadfix::bench {

FeatureMap as_one(std::span<const PlacedFeatures> frames) {
  return frames.size() == 1 ? frames.front().features : combined(frames, cli::kMaxCells);
}

FeatureMap seen_from(const GeoPose& place, const Query& query, std::span<const PlacedFeatures> frames,
                     const MapView& map) {
  if (!query.altitude || !map.terrain) return as_one(frames);
  return as_one(levelled_frames(map, frames, *query.altitude, on_grid(place, map.zone)));
}

}  // namespace roadfix::bench
