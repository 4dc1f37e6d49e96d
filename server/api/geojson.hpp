// Geometries of GeoJSON that are cut at 180 degrees (RFC 7946 section 3.1.9). Continued beyond it they would be whole
// on maps such as Leaflet's, but run around the world where a program projects them, as QGIS does for its background
// maps, and lie a world away from the points of the same answer, whose longitudes are within [-180, 180].
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "core/geodesy/latlon.hpp"

namespace roadfix::api {

/// Neighbours in a part lie on one side of the meridian of 180 degrees, where it is cut. Parts that would be a single
/// place are left out. Of neighbours the shorter way is meant, as of all flights. There is a place at least, and all
/// are in [-180, 180].
std::vector<std::vector<LatLon>> cut_at_180(std::span<const LatLon> places);

nlohmann::json point_json(LatLon place);

/// A LineString, or a MultiLineString of the parts. Of neighbours the shorter way is meant, as of all flights. There
/// are two places at least, in [-180, 180].
nlohmann::json line_json(std::span<const LatLon> places);
/// The same of several lines in one geometry, of at least one.
nlohmann::json line_json(std::span<const std::vector<LatLon>> lines);

/// A Polygon, or a MultiPolygon of the parts. The ring is convex and ends where it begins.
nlohmann::json polygon_json(std::span<const LatLon> ring);

}  // namespace roadfix::api
