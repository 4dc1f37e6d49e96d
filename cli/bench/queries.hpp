// The queries of a set: frames cut from imagery, real frames with truth, or simulated feature maps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/bench/manifest.hpp"
#include "cli/bench/query.hpp"

namespace roadfix::bench {

struct QueryDrawing {
  std::uint64_t seed = 1;
  std::uint64_t set = 0;  ///< index of the set in the manifest
  int limit = 0;          ///< at most so many; 0 = all
};

struct DrawnQueries {
  std::vector<Query> queries;
  std::vector<std::string> left_out;  ///< why the whole set, or which of its frames and why
};

/// `map` is searched; simulated queries are cut out of `from`; of camera frames what `detector` makes use of is kept.
/// Where one query of a set finds no place, all of the set are left out; frames that cannot be read, one by one.
/// Throws InvalidInput "frames-csv" naming line and column, "frames-outside-map" where no frame lies on the map,
/// "position-outside-zone" naming one that is far away, "prior-outside-map", of frames that tell their height above the
/// sea "terrain-missing" and "frames-without-size", and what reading the imagery throws.
DrawnQueries make_queries(const QuerySet& set, const MapView& map, const MapView& from, const RoadDetector& detector,
                          const QueryDrawing& drawing);

/// Of simulated feature maps that are all equally bad; otherwise nullopt.
std::optional<FeatureQuality> common_quality(const QuerySet& set);

/// In a few words what tells the set from others over the same map: "post.jpg 400x400 m", "frames.csv, prior 500 m",
/// "simulated 400x400 m, 0 to 60 % erased".
std::string describe(const QuerySet& set);

}  // namespace roadfix::bench
