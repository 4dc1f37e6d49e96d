// A line or points of GeoJSON (RFC 7946), as programs for maps draw them.
#pragma once

#include "core/routes/route.hpp"
#include "core/units/json_file.hpp"

namespace roadfix::routes {

/// The first LineString or MultiLineString (one that is cut at 180 degrees), further ones being left out by name, or
/// all points in their order, of a FeatureCollection, a Feature or a geometry, also in a GeometryCollection. A third
/// number counts as a height above the sea, as programs for maps draw it from elevation models; RFC 7946 has it above
/// the ellipsoid. Where all are 0, none is told. Throws InvalidInput "waypoints-unreadable".
Route parse_geojson_line(const JsonField& document);

}  // namespace roadfix::routes
