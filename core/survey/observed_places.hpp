// The places of a map that can be asked about: those around which it has observed ground.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/locate/map_view.hpp"

namespace roadfix {

struct ObservedPlaces {
  /// Neighbours on the ground are close in the list, so that every n-th place is an evenly spread sample.
  std::vector<GridPoint> places;
  double ground_m2 = 0.0;  ///< observed within their rectangles
};

/// Divides the extent of the map into equal rectangles about as large as a footprint, and lists the middles of those
/// where at least `min_share` of a north-up footprint was observed, as far as overviews tell. Reads only where there is
/// ground: a map of two towns far apart costs no more than the towns. Throws what the map's read() throws, and
/// Interrupted "search-stopped".
ObservedPlaces observed_places(const MapView& map, double footprint_m, double min_share, std::stop_token stop = {});

}  // namespace roadfix
