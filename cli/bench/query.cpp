#include "cli/bench/query.hpp"

#include <optional>
#include <utility>

namespace roadfix::bench {

FeatureMap seen_above(const GeoPose& place, const Query& query, FeatureMap features, const MapView& map) {
  if (!query.altitude || !map.terrain) return features;
  const auto agl_m = map.terrain->height_above_ground_m(map.zone.project(place.position), query.altitude->above_sea_m);
  return agl_m ? seen_from(std::move(features), *query.altitude, *agl_m) : features;
}

}  // namespace roadfix::bench
