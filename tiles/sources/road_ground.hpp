// The ground that the roads of a layer stand for, and how well its place is known. For the reader of road lines; not
// for other modules.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "core/geodesy/utm.hpp"
#include "tiles/sources/road_layer.hpp"
#include "tiles/sources/road_lines.hpp"
#include "tiles/sources/vector_file.hpp"

namespace roadfix {

/// Lines of the layers that tell roads apart, and of those that do not.
struct RoadParts {
  RoadNetwork classified;
  RoadNetwork plain;
  std::size_t classified_before = 0;  ///< lines of the files before the one that is read
  std::size_t plain_before = 0;
  bool any_layer = false;
  bool any_classified = false;
  std::int64_t features = 0;
  std::int64_t lines = 0;
  std::map<std::string, std::int64_t> unknown_classes;
  std::int64_t without_class = 0;        ///< lines of layers with classes
  std::int64_t roads_without_class = 0;  ///< those of them that nothing calls a river or the like
  bool strays_noted = false;
  bool bare_rim_noted = false;
  /// Layers of lines without classes by name: the first file that has them, and their attributes.
  std::map<std::string, std::pair<std::string, std::string>> plain_layers;

  RoadNetwork& network_of(const RoadLayer& layer) { return layer.classified() ? classified : plain; }
  std::span<const RoadLine> lines_of_file(const RoadLayer& layer) const {
    return layer.classified() ? std::span(classified.lines).subspan(classified_before)
                              : std::span(plain.lines).subspan(plain_before);
  }
};

/// Throws InvalidInput "degrees-as-metres" where the coordinates of a projected reference system could all be
/// longitudes and latitudes: none has its roads within 360 m of its origin.
void refuse_degrees_as_metres(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path);
void refuse_degrees_as_metres(VectorFile& file, const RoadLayer& layer);

/// Takes down how well the place of the layer's roads is known.
void add_datum_error(VectorFile& file, const RoadLayer& layer, UtmZone zone, RoadParts& parts);

/// Takes down the ground that the layer covers, with a note where a few roads stretch it or much of it is bare. Throws
/// InvalidInput ("crs-not-transformable", "roads-around-the-earth").
void add_covered(VectorFile& file, const RoadLayer& layer, UtmZone zone, RoadParts& parts);

}  // namespace roadfix
