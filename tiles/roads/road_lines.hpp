// Reads road centrelines from anything that OGR reads into memory, in the plane of a zone.
//
// Memory: 16 bytes a point and 32 bytes a line, about 40 MB for a country of a million road segments.
#pragma once

#include <cstdint>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "core/geodesy/latlon.hpp"
#include "core/geodesy/utm.hpp"
#include "core/units/progress.hpp"
#include "tiles/roads/plane_polygon.hpp"
#include "tiles/roads/road_rules.hpp"

namespace roadfix {

struct VectorOptions {
  std::string crs;    ///< replaces that of the file
  std::string layer;  ///< only this one; empty for all
  /// Ground that the source covers: "W,S,E,N" in degrees (W above E across the antimeridian) or a file with polygons
  /// (of OGR, or a polygon filter of Osmosis), whose holes are not covered; empty = bounding box of the lines of each
  /// layer, at least 32 m and twice the widest road across (of the tile for vector tiles).
  std::string extent;
  std::stop_token stop = {};   ///< ends the reading of features: those of a country take minutes
  OnProgress on_reading = {};  ///< gets how far the reading of features is, where the format tells
};

struct RoadLine {
  std::size_t first_point = 0;
  std::size_t points = 0;
  double half_width_m = 0.0;
  std::size_t road_class = 0;  ///< index into RoadNetwork::classes
};

struct RoadNetwork {
  std::vector<GridPoint> points;
  std::vector<RoadLine> lines;
  std::vector<std::string> classes;  ///< each once, as it stands in the file; empty of lines without
  std::vector<PlanePolygon> covered;
  std::map<std::string, std::vector<double>> stated_widths;  ///< in metres, of the roads drawn so, by attribute
  std::int64_t left_out = 0;  ///< features that the rules leave out or that have no place in the zone
  std::int64_t areas = 0;     ///< those of them that would be drawn if they were lines, of layers with lines
  std::string crs;
  double datum_sigma_m = 0.0;      ///< see datum_error(); of the layer whose place is the least certain
  std::string class_attribute;     ///< of the first layer that has one where the rules do not name it; else empty
  std::vector<std::string> notes;  ///< what was assumed, for the user to read: one for each layer name
};

/// The class attribute is that of the rules; where a layer lacks it and the user named none, the first of fclass, type,
/// class and road_class whose values are mostly classes (of fclass a tenth is enough). Where no layer has any, every
/// line is a road; where some layers of lines have one, the lines of the others (rivers, bus routes) are not drawn. OSM
/// PBF and XML, GeoJSON, Shapefile, GeoPackage, vector tiles named Z-X-Y.mvt or Z/X/Y.mvt, ... Throws NotFound,
/// InvalidInput ("source-unreadable", "layer-unknown" where none of the files has it, "roads-without-georeference",
/// "source-without-roads", "crs-not-transformable", "degrees-as-metres", "extent-unreadable", "roads-around-the-earth"
/// where they span more than 180 degrees of longitude and no extent is given), CorruptData ("roads-unreadable") or
/// IoFailure ("temporary-files-refused").
RoadNetwork read_road_network(const std::vector<std::string>& paths, const VectorOptions& options,
                              const RoadRules& rules, UtmZone zone);

/// Geographic centre of the ground that is asked for, or of the first layer with features, to choose a zone by; layers
/// of points or areas count where no other has any.
LatLon centre_of_roads(const std::vector<std::string>& paths, const VectorOptions& options);

}  // namespace roadfix
