#include "tiles/roads/stated_extent.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <memory>
#include <numeric>
#include <span>
#include <system_error>

#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "tiles/roads/line_on_plane.hpp"
#include "tiles/roads/poly_file.hpp"
#include "tiles/roads/vector_file.hpp"

namespace roadfix {
namespace {

std::vector<GridPoint> ring_on_plane(const OGRLinearRing& ring, OGRCoordinateTransformation& to_plane,
                                     const std::string& path) {
  constexpr double kLongestM = 1000.0;
  if (ring.IsEmpty() != FALSE) return {};
  OGRLinearRing closed(ring);
  closed.closeRings();
  if (const auto points = line_on_plane(closed, to_plane, kLongestM)) return *points;
  throw InvalidInput("extent-unreadable", fmt::format("{}: the polygon has no place in the zone of the map", path));
}

/// Of geometries without arcs.
void add_polygons(const OGRGeometry& geometry, OGRCoordinateTransformation& to_plane, const std::string& path,
                  std::vector<PlanePolygon>& polygons) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) add_polygons(*part, to_plane, path, polygons);
  }
  if (type != wkbPolygon || geometry.IsEmpty() != FALSE) return;
  const OGRPolygon& polygon = *geometry.toPolygon();
  if (polygon.getExteriorRing()->getNumPoints() < 3) return;
  const std::vector<GridPoint> outer = ring_on_plane(*polygon.getExteriorRing(), to_plane, path);
  std::vector<std::vector<GridPoint>> holes;
  for (int i = 0; i < polygon.getNumInteriorRings(); ++i) {
    holes.push_back(ring_on_plane(*polygon.getInteriorRing(i), to_plane, path));
  }
  polygons.emplace_back(outer, holes);
}

[[noreturn]] void refuse_extent_without_polygons(const std::string& extent) {
  throw InvalidInput("extent-unreadable", fmt::format("{}: holds no polygon that could say what is covered", extent));
}

/// --crs is about the roads.
OGRSpatialReference crs_of_extent(const VectorFile& file, OGRLayer& layer) {
  if (layer.GetSpatialRef() != nullptr) return file.crs_of(layer);
  throw InvalidInput("extent-unreadable",
                     fmt::format("{}: layer '{}' has no reference system: give it one in the program that it comes "
                                 "from and save it again, or write --extent W,S,E,N in degrees",
                                 file.path(), layer.GetName()));
}

/// Of four parts, or of nothing but digits and what separates them; and no file.
bool looks_like_numbers(const std::string& extent) {
  std::error_code none;
  return (split(extent, ',').size() == 4 || extent.find_first_not_of("0123456789.,;+- ") == std::string::npos) &&
         !std::filesystem::exists(extent, none);
}

}  // namespace

std::optional<GeoBox> box_in_degrees(const std::string& extent) {
  const std::optional<std::vector<double>> sides = numbers_in(extent, ',');
  const bool four = sides && sides->size() == 4;
  if (!four && !looks_like_numbers(extent)) return std::nullopt;
  const std::optional<GeoBox> box = four ? told_box(std::span<const double, 4>(*sides)) : std::nullopt;
  if (!box) {
    throw InvalidInput(
        "extent-unreadable",
        fmt::format("--extent {}: write west,south,east,north in degrees, west and south first", extent));
  }
  return box;
}

std::vector<PlanePolygon> read_extent(const std::string& extent, UtmZone zone) {
  const OGRSpatialReference plane = utm_reference(zone);
  if (const std::optional<GeoBox> box = box_in_degrees(extent)) {
    OGREnvelope degrees;
    degrees.Merge(box->south_west.lon_deg, box->south_west.lat_deg);
    degrees.Merge(box->north_east.lon_deg, box->north_east.lat_deg);
    const TransformationPtr to_plane = transformation(wgs84_reference(), plane, "--extent");
    return {box_on_plane(degrees, *to_plane, "--extent")};
  }
  std::vector<PlanePolygon> polygons;
  if (is_poly_file(extent)) {
    add_polygons(*read_poly_file(extent), *transformation(wgs84_reference(), plane, extent), extent, polygons);
  } else {
    VectorFile file(extent, {});
    file.for_each_feature([&](OGRLayer& layer, OGRFeature& feature) {
      if (feature.GetGeometryRef() == nullptr) return;
      const TransformationPtr to_plane = transformation(crs_of_extent(file, layer), plane, extent);
      const std::unique_ptr<OGRGeometry> straight(feature.GetGeometryRef()->getLinearGeometry());
      if (straight) add_polygons(*straight, *to_plane, extent, polygons);
    });
  }
  if (polygons.empty()) refuse_extent_without_polygons(extent);
  return polygons;
}

LatLon centre_of_extent(const std::string& extent) {
  if (const std::optional<GeoBox> box = box_in_degrees(extent)) {
    return {std::midpoint(box->south_west.lat_deg, box->north_east.lat_deg),
            std::midpoint(box->south_west.lon_deg, box->north_east.lon_deg)};
  }
  if (is_poly_file(extent)) {
    OGREnvelope box;
    read_poly_file(extent)->getEnvelope(&box);
    return {(box.MinY + box.MaxY) / 2.0, (box.MinX + box.MaxX) / 2.0};
  }
  VectorFile file(extent, {});
  for (OGRLayer* layer : file.layers()) {
    const std::optional<OGREnvelope> own = file.extent_of(*layer);
    if (own) {
      const OGRSpatialReference crs = crs_of_extent(file, *layer);
      return centre_on_earth(*own, crs, extent, "write the right one into the file");
    }
  }
  refuse_extent_without_polygons(extent);
}

}  // namespace roadfix
