// Roadfix itself: detect roads in the frame, search the map for them.
#pragma once

#include <memory>

#include "cli/bench/query.hpp"
#include "core/detect/road_detector.hpp"

namespace roadfix::bench {

struct RoadsOptions {
  double cell_m = 2.0;
  std::uint64_t seed = 1;
  FixOptions fix;
};

/// `map` must outlive the method.
std::unique_ptr<Method> make_roads_method(const MapView& map, std::shared_ptr<const RoadDetector> detector,
                                          const RoadsOptions& options);

}  // namespace roadfix::bench
