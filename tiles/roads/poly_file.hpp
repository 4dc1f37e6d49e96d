// The polygon filter files of Osmosis, which Geofabrik ships beside its extracts of OpenStreetMap: sections of points
// in degrees, each a ring that ends with END; one whose name begins with '!' is a hole.
// https://wiki.openstreetmap.org/wiki/Osmosis/Polygon_Filter_File_Format
#pragma once

#include <ogr_geometry.h>

#include <memory>
#include <string>

namespace roadfix {

/// By its name, since OGR does not read them.
bool is_poly_file(const std::string& path);

/// In degrees of WGS 84, each hole in the ring around it. Throws InvalidInput "extent-unreadable" with `path` and the
/// number of the line.
std::unique_ptr<OGRMultiPolygon> parse_poly(const std::string& text, const std::string& path);
/// Throws NotFound "file-not-found" too.
std::unique_ptr<OGRMultiPolygon> read_poly_file(const std::string& path);

}  // namespace roadfix
