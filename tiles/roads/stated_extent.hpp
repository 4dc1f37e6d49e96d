// The ground that the user says a source of road lines covers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geodesy/geo_box.hpp"
#include "tiles/roads/plane_polygon.hpp"

namespace roadfix {

/// "W,S,E,N" in degrees, nullopt for other texts; where it crosses the antimeridian E is above 180. Throws InvalidInput
/// "extent-unreadable".
std::optional<GeoBox> box_in_degrees(const std::string& extent);

/// See VectorOptions::extent.
std::vector<PlanePolygon> read_extent(const std::string& extent, UtmZone zone);
LatLon centre_of_extent(const std::string& extent);

}  // namespace roadfix
