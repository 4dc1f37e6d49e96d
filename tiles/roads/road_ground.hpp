// The ground that the roads of a layer stand for, and how well its place is known. For the reader of road lines; not
// for other modules.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/geodesy/utm.hpp"
#include "tiles/roads/plane_polygon.hpp"
#include "tiles/roads/road_layer.hpp"
#include "tiles/roads/road_lines.hpp"
#include "tiles/roads/vector_file.hpp"
#include "tiles/sources/datum_error.hpp"

namespace roadfix {

/// Throws InvalidInput "degrees-as-metres" (no projected reference system has its roads within 360 m of its origin) and
/// "axes-swapped".
void require_likely_coordinates(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path);
void require_likely_coordinates(VectorFile& file, const RoadLayer& layer);

/// Throws InvalidInput "crs-not-transformable" where most lines have coordinates of no place on Earth, which is more
/// than an accident.
void refuse_as_nowhere(VectorFile& file, const RoadLayer& layer);

/// How well the place of the layer's roads is known, where their datum is an old one; else 0 m.
PositionError datum_error_of(VectorFile& file, const RoadLayer& layer, UtmZone zone);

struct LayerGround {
  PlanePolygon covered;
  std::optional<std::string> strays;  ///< what to tell where a few roads stretch it
};

/// nullopt where the layer tells nothing of roads. `lines` are those of `network` that come from the file. Throws
/// InvalidInput ("crs-not-transformable", "roads-around-the-earth").
std::optional<LayerGround> ground_of(VectorFile& file, const RoadLayer& layer, const RoadNetwork& network,
                                     std::span<const RoadLine> lines, UtmZone zone);

}  // namespace roadfix
