#include "tiles/world/road_truth.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <array>
#include <optional>

#include "core/units/error.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix::world {
namespace {

struct Piece {
  PlanPoint from;
  PlanPoint to;
};

/// Liang and Barsky's clipping of a segment at a box.
std::optional<Piece> clipped(PlanPoint a, PlanPoint b, double width_m, double height_m) {
  const PlanPoint d = b - a;
  double enter = 0.0;
  double leave = 1.0;
  const std::array<std::array<double, 2>, 4> sides{
      {{-d.x, a.x}, {d.x, width_m - a.x}, {-d.y, a.y}, {d.y, height_m - a.y}}};
  for (const auto& [out, room] : sides) {
    if (out == 0.0) {
      if (room < 0.0) return std::nullopt;
    } else if (out < 0.0) {
      enter = std::max(enter, room / out);
    } else {
      leave = std::min(leave, room / out);
    }
  }
  if (enter >= leave) return std::nullopt;
  return Piece{a + d * enter, a + d * leave};
}

/// Value of OpenStreetMap's `surface`; none for a town's streets.
const char* surface_tag(Surface surface) {
  switch (surface) {
    case Surface::kKerbed:
      return nullptr;
    case Surface::kAsphalt:
      return "asphalt";
    case Surface::kGravel:
      return "gravel";
    case Surface::kEarth:
      return "earth";
    case Surface::kSand:
      return "sand";
  }
  return nullptr;
}

void require(bool done, const std::string& path, const GdalMessages& messages) {
  if (!done) throw IoFailure("world-unwritable", fmt::format("{}: cannot be written ({})", path, messages.text()));
}

void add(OGRLayer& layer, const Street& street, const Polyline& line, const Placement& placement,
         const std::string& path, const GdalMessages& messages) {
  OGRLineString geometry;
  for (const PlanPoint& p : line) {
    const LatLon at = placement.zone.unproject(placement.point_of(p.x / placement.gsd_m, p.y / placement.gsd_m));
    geometry.addPoint(at.lon_deg, at.lat_deg);
  }
  OGRFeature feature(layer.GetLayerDefn());
  feature.SetField("highway", street.road_class.c_str());
  feature.SetField("width_m", street.width_m);
  if (const char* surface = surface_tag(street.surface)) feature.SetField("surface", surface);
  feature.SetGeometry(&geometry);
  require(layer.CreateFeature(&feature) == OGRERR_NONE, path, messages);
}

}  // namespace

std::vector<Polyline> clipped(const Polyline& line, double width_m, double height_m) {
  std::vector<Polyline> parts;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const std::optional<Piece> piece = clipped(line[i], line[i + 1], width_m, height_m);
    if (!piece) continue;
    if (parts.empty() || parts.back().back() != piece->from) parts.push_back({piece->from});
    parts.back().push_back(piece->to);
  }
  return parts;
}

int write_road_truth(const std::string& path, const std::vector<Street>& streets, const Placement& placement) {
  require_gdal();
  const GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GeoJSON");
  require(driver != nullptr, path, messages);
  const DatasetPtr dataset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  require(dataset != nullptr, path, messages);
  OGRSpatialReference reference = wgs84_reference();
  CPLStringList options;
  options.SetNameValue("COORDINATE_PRECISION", "8");
  OGRLayer* layer = dataset->CreateLayer("roads", &reference, wkbLineString, options.List());
  require(layer != nullptr, path, messages);
  OGRFieldDefn road_class("highway", OFTString);
  OGRFieldDefn width("width_m", OFTReal);
  OGRFieldDefn surface("surface", OFTString);
  for (OGRFieldDefn* field : {&road_class, &width, &surface}) {
    require(layer->CreateField(field) == OGRERR_NONE, path, messages);
  }
  int count = 0;
  for (const Street& street : streets) {
    for (const Polyline& line :
         clipped(street.line, placement.cols * placement.gsd_m, placement.rows * placement.gsd_m)) {
      add(*layer, street, line, placement, path, messages);
      ++count;
    }
  }
  return count;
}

}  // namespace roadfix::world
