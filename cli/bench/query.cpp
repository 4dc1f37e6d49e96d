#include "cli/bench/query.hpp"

#include <utility>

#include "core/grid/relief.hpp"

namespace roadfix::bench {

FeatureMap seen_above(const GeoPose& place, const Query& query, FeatureMap features, const MapView& map) {
  if (!query.altitude || !map.terrain) return features;
  const GridPose there = on_grid(place, map.zone);
  double agl_m = query.altitude->agl_m;
  if (const auto above_sea_m = query.altitude->above_sea_m) {
    agl_m = map.terrain->height_above_ground_m(there.position, *above_sea_m).value_or(agl_m);
  }
  return levelled(seen_from(std::move(features), *query.altitude, agl_m), Relief(*map.terrain, there, agl_m));
}

}  // namespace roadfix::bench
