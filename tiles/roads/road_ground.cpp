#include "tiles/roads/road_ground.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>

#include "core/grid/geometry.hpp"
#include "core/units/error.hpp"
#include "tiles/roads/stray_roads.hpp"
#include "tiles/sources/coordinate_limits.hpp"

namespace roadfix {
namespace {

/// Of the ground that a layer says something about: as much as its widest road, or the largest cell, on either side of
/// a straight line.
double min_side_m(std::span<const RoadLine> lines) {
  double side_m = 2.0 * kMaxCellM;
  for (const RoadLine& line : lines) side_m = std::max(side_m, 4.0 * line.half_width_m);
  return side_m;
}

/// No map holds what lies on two sides of the Earth, and roads on both sides of the 180th meridian seem to. `strays` is
/// what is to be said of where most of them lie, or empty.
void require_one_side_of_the_earth(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path,
                                   const std::string& strays) {
  const TransformationPtr to_earth = transformation(crs, wgs84_reference(), path);
  std::array<double, 2> lon{box.MinX, box.MaxX};
  std::array<double, 2> lat{(box.MinY + box.MaxY) / 2.0, (box.MinY + box.MaxY) / 2.0};
  const GdalMessages messages;
  if (to_earth->Transform(2, lon.data(), lat.data()) == FALSE || !(lon[1] - lon[0] > 180.0)) return;
  throw InvalidInput(
      "roads-around-the-earth",
      fmt::format("{}: it reaches from longitude {:.2f} to {:.2f}, and no map holds both. Name the ground of the map "
                  "with --extent W,S,E,N; across the 180th meridian W is larger than E, as in 179.5,-17,-179.5,-16{}{}",
                  path, lon[0], lon[1], strays.empty() ? "" : ". ", strays));
}

}  // namespace

void require_likely_coordinates(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path) {
  refuse_degrees_as_metres(box, crs, path);
  refuse_swapped_axes(box, crs, path);
}

void require_likely_coordinates(VectorFile& file, const RoadLayer& layer) {
  const std::optional<OGREnvelope> box = layer.extent_seen();
  if (layer.counts().lines > 0 && box) require_likely_coordinates(*box, file.crs_of(layer.layer()), file.path());
}

void refuse_as_nowhere(VectorFile& file, const RoadLayer& layer) {
  if (layer.counts().impossible > layer.counts().lines) refuse_as_nowhere(file.path(), "give the right one with --crs");
}

PositionError datum_error_of(VectorFile& file, const RoadLayer& layer, UtmZone zone) {
  const std::optional<OGREnvelope> box = layer.extent_seen();
  if (layer.counts().lines == 0 || !box) return {};
  const OGRSpatialReference crs = file.crs_of(layer.layer());
  double east_m = (box->MinX + box->MaxX) / 2.0;
  double north_m = (box->MinY + box->MaxY) / 2.0;
  const GdalMessages messages;
  if (!on_old_ellipsoid(crs) || layer.to_plane().Transform(1, &east_m, &north_m) == FALSE) return {};
  return datum_error(crs, zone, zone.unproject({east_m, north_m}), file.path());
}

std::optional<LayerGround> ground_of(VectorFile& file, const RoadLayer& layer, const RoadNetwork& network,
                                     std::span<const RoadLine> lines, UtmZone zone) {
  const bool tile = vector_tile_of(file.path()).has_value();
  if (layer.counts().lines == 0 && !tile) return std::nullopt;  // shops say nothing about roads
  std::optional<OGREnvelope> box = file.cut_out(layer.layer());
  if (!box) box = layer.extent_seen();
  if (!box) return std::nullopt;
  OGRCoordinateTransformation& to_plane = layer.to_plane();
  LayerGround ground{box_on_plane(with_sides_of(*box, min_side_m(lines), to_plane), to_plane, file.path()), {}};
  if (tile) return ground;
  ground.strays = note_on_stray_roads(network, lines, ground.covered.box(), zone);
  require_one_side_of_the_earth(*box, file.crs_of(layer.layer()), file.path(), ground.strays.value_or(""));
  return ground;
}

}  // namespace roadfix
