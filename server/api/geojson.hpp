// Geometries of GeoJSON that are cut at 180 degrees (RFC 7946 section 3.1.9). Continued beyond it they would be whole
// on maps such as Leaflet's, but run around the world where a program projects them, as QGIS does for its background
// maps, and lie a world away from the points of the same answer, whose longitudes are within [-180, 180].
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "core/geodesy/latlon.hpp"

namespace roadfix::api {

/// A LineString, or a MultiLineString of the parts. Of neighbours the shorter way is meant, as of all flights. There
/// are two places at least, in [-180, 180].
nlohmann::json line_json(std::span<const LatLon> places);
/// The same of several lines in one geometry, of at least one.
nlohmann::json line_json(std::span<const std::vector<LatLon>> lines);

/// A Polygon, or a MultiPolygon of the parts. The ring is convex and ends where it begins.
nlohmann::json polygon_json(std::span<const LatLon> ring);

}  // namespace roadfix::api
