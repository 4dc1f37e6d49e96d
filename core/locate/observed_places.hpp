// The places of a map that can be asked about: those around which it has observed ground.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/locate/map_view.hpp"

namespace roadfix {

struct ObservedPlaces {
  /// Neighbours on the ground are near each other in the list: every n-th of them are evenly spread.
  std::vector<GridPoint> places;
  double ground_m2 = 0.0;  ///< observed within their rectangles
};

/// The extent of the map is divided into equal rectangles, about as large as a footprint. Lists the middles of those
/// where at least `min_share` of a footprint, north up, was observed, as far as overviews tell. Reads where there is
/// ground only, so that a map of two towns far apart costs no more than the towns. Throws what the map's read() throws
/// and Interrupted "search-stopped".
ObservedPlaces observed_places(const MapView& map, double footprint_m, double min_share, std::stop_token stop = {});

}  // namespace roadfix
