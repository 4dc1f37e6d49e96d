#include "tiles/roads/vector_file.hpp"

#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <regex>

#include "core/units/error.hpp"
#include "tiles/roads/road_geometry.hpp"
#include "tiles/roads/shapefile_records.hpp"
#include "tiles/sources/prj_file.hpp"
#include "tiles/sources/temporary_files.hpp"

namespace roadfix {
namespace {

DatasetPtr open_vector(const std::string& path, const std::optional<VectorTile>& tile) {
  CPLStringList options;
  if (tile) {
    options.SetNameValue("X", fmt::format("{}", tile->x).c_str());
    options.SetNameValue("Y", fmt::format("{}", tile->y).c_str());
    options.SetNameValue("Z", fmt::format("{}", tile->zoom).c_str());
    options.SetNameValue("CLIP", "NO");
  }
  return open_dataset(path, GDAL_OF_VECTOR, options.List());
}

/// GDAL takes a GeoJSON file that names a reference system which PROJ does not know for WGS 84, and says so in passing.
DatasetPtr open_in_known_crs(const std::string& path, const std::optional<VectorTile>& tile,
                             const VectorOptions& options) {
  const GdalMessages messages;
  DatasetPtr dataset = open_vector(path, tile);
  const std::string said = messages.text();
  if (options.crs.empty() && said.starts_with("PROJ: ") && said.find("crs not found") != std::string::npos) {
    throw InvalidInput(
        "crs-unknown",
        fmt::format("{}: it names a reference system that is not known ({}): give its own with --crs, for "
                    "example --crs EPSG:32637",
                    path, said));
  }
  return dataset;
}

/// What is known without reading the features. A Shapefile without geometries says that they lie at zero.
std::optional<OGREnvelope> stored_extent(OGRLayer& layer) {
  const GdalMessages messages;
  OGREnvelope box;
  if (layer.GetExtent(&box, FALSE) != OGRERR_NONE || box.MinX > box.MaxX) return std::nullopt;
  if (box.MinX == 0.0 && box.MaxX == 0.0 && box.MinY == 0.0 && box.MaxY == 0.0) return std::nullopt;
  return box;
}

/// Whether lines, areas and points may share the layer.
bool may_be_mixed(OGRLayer& layer) {
  const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
  return type == wkbUnknown || type == wkbGeometryCollection;
}

/// Infinite where it takes reading them.
double count_in(const std::vector<OGRLayer*>& layers) {
  const GdalMessages messages;
  double count = 0.0;
  for (OGRLayer* layer : layers) {
    const GIntBig known = layer->GetFeatureCount(FALSE);
    count += known < 0 ? std::numeric_limits<double>::infinity() : static_cast<double>(known);
  }
  return count;
}

}  // namespace

std::optional<VectorTile> vector_tile_of(const std::string& path) {
  static const std::regex pattern(R"((?:^|.*/)(\d{1,2})[-/](\d{1,8})[-/](\d{1,8})\.(?:mvt|pbf)$)");
  std::smatch match;
  if (!std::regex_match(path, match, pattern)) return std::nullopt;
  const VectorTile tile{std::stoi(match[1]), std::stoi(match[2]), std::stoi(match[3])};
  constexpr int kMaxZoom = 24;
  if (tile.zoom > kMaxZoom || tile.x >= (1 << tile.zoom) || tile.y >= (1 << tile.zoom)) return std::nullopt;
  return tile;
}

VectorFile::VectorFile(const std::string& path, const VectorOptions& options)
    : path_(path), options_(options), tile_(vector_tile_of(path)), dataset_(open_in_known_crs(path, tile_, options)) {
  osm_ = EQUAL(dataset_->GetDriverName(), "OSM");
  if (EQUAL(dataset_->GetDriverName(), "ESRI Shapefile")) require_as_many_records_as_shapes(*dataset_, path_);
  for (int i = 0; i < dataset_->GetLayerCount(); ++i) {
    OGRLayer* layer = dataset_->GetLayer(i);
    const std::string name = layer->GetName();
    // QGIS keeps styles in tables beside the layers of a GeoPackage.
    const bool usual = layer->GetGeomType() != wkbNone && (!osm_ || name == "lines");
    if (options.layer.empty() ? usual : name == options.layer) layers_.push_back(layer);
  }
}

std::string VectorFile::layer_names() const {
  std::string names;
  for (int i = 0; i < dataset_->GetLayerCount(); ++i) {
    names += fmt::format("{}'{}'", i == 0 ? "" : ", ", dataset_->GetLayer(i)->GetName());
  }
  return names;
}

OGRSpatialReference VectorFile::crs_of(OGRLayer& layer) const {
  if (auto known = known_crs_of(layer)) return *known;
  throw InvalidInput("roads-without-georeference",
                     fmt::format("{}: layer '{}' has no reference system{}; name it with --crs, for example --crs "
                                 "EPSG:32637",
                                 path_, layer.GetName(), not_on_earth(layer.GetSpatialRef())));
}

std::optional<OGRSpatialReference> VectorFile::known_crs_of(OGRLayer& layer) const {
  if (!options_.crs.empty()) return parse_crs(options_.crs);
  const OGRSpatialReference* own = layer.GetSpatialRef();
  if (own == nullptr || !lies_on_earth(*own)) return crs_beside(path_);
  OGRSpatialReference crs = *own;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

std::optional<OGREnvelope> VectorFile::extent_of(OGRLayer& layer) {
  const std::optional<OGREnvelope> stated = cut_out(layer);
  return stated ? stated : bounding_box(layer);
}

std::optional<OGREnvelope> VectorFile::cut_out(OGRLayer& layer) const {
  if (osm_) return stored_extent(layer);
  if (!tile_) return std::nullopt;
  const double half = 6378137.0 * std::numbers::pi;
  const double side = std::ldexp(2.0 * half, -tile_->zoom);
  OGREnvelope box;
  box.MinX = -half + tile_->x * side;
  box.MaxX = box.MinX + side;
  box.MaxY = half - tile_->y * side;
  box.MinY = box.MaxY - side;
  return box;
}

std::optional<OGREnvelope> VectorFile::bounding_box(OGRLayer& layer) {
  const CoordinateLimits limits = limits_of(layer);
  // A GeoPackage states what it ever held: few programs make that smaller when features go.
  if (!EQUAL(dataset_->GetDriverName(), "GPKG") && !may_be_mixed(layer)) {
    std::optional<OGREnvelope> stored = stored_extent(layer);
    if (stored && limits.hold(*stored)) return stored;
  }
  OGREnvelope lines;
  OGREnvelope others;
  const auto add = [&](OGRLayer& of, OGRFeature& feature) {
    const OGRGeometry* geometry = feature.GetGeometryRef();
    if (&of != &layer || geometry == nullptr || geometry->IsEmpty() != FALSE) return;
    OGREnvelope own;
    geometry->getEnvelope(&own);
    (holds_a_line(*geometry) && limits.hold(*geometry) ? lines : others).Merge(own);
  };
  osm_ ? for_each_feature(add) : for_each_feature_of({&layer}, add);  // OpenStreetMap's layers come interleaved only
  const OGREnvelope& box = lines.IsInit() != 0 ? lines : others;
  return box.IsInit() != 0 ? std::optional(box) : std::nullopt;
}

/// A layer without a reference system is refused by whoever needs one.
CoordinateLimits VectorFile::limits_of(OGRLayer& layer) const {
  return coordinate_limits(known_crs_of(layer).value_or(wgs84_reference()));
}

void VectorFile::for_each_feature(const Visit& visit) {
  if (!osm_) {  // what other layers and tables of the file hold is no concern
    for_each_feature_of(layers_, visit);
    return;
  }
  dataset_->ResetReading();
  OGRLayer* layer = nullptr;
  double share = 0.0;
  const auto next = [&] { return dataset_->GetNextFeature(&layer, &share, nullptr, nullptr); };
  while (const OGRFeatureUniquePtr feature = read(next)) {
    visit(*layer, *feature);
    tell(share);
  }
  tell(1.0);
}

void VectorFile::for_each_feature_of(const std::vector<OGRLayer*>& layers, const Visit& visit) {
  const double count = count_in(layers);
  double seen = 0.0;
  for (OGRLayer* layer : layers) {
    layer->ResetReading();
    const auto next = [&] { return layer->GetNextFeature(); };
    while (const OGRFeatureUniquePtr feature = read(next)) {
      visit(*layer, *feature);
      tell(++seen / count);
    }
  }
  tell(1.0);
}

void VectorFile::tell(double share) const {
  constexpr double kWhole = 1e6;
  if (options_.on_reading) options_.on_reading(std::lround(kWhole * std::min(1.0, share)), std::lround(kWhole));
}

/// Refuses what GDAL says of reading alone: what PROJ says of coordinates while features are visited is no damage.
OGRFeatureUniquePtr VectorFile::read(const std::function<OGRFeature*()>& next) const {
  if (options_.stop.stop_requested()) {
    throw Interrupted("work-stopped", fmt::format("stopped while {} was read: nothing was changed", path_));
  }
  const GdalMessages messages;
  OGRFeatureUniquePtr feature(next());
  refuse_unread(messages);
  return feature;
}

/// Where reading ended in a failure.
void VectorFile::refuse_unread(const GdalMessages& messages) const {
  const std::string said = messages.text();
  if (said == GdalMessages::kNone) return;
  if (is_about_temporary_files(said)) {
    throw IoFailure(
        "temporary-files-refused",
        fmt::format("{}: what is read of it does not fit into memory, and finds no room in a file ({}). Name "
                    "a folder that may be written to and has room: CPL_TMPDIR=FOLDER roadfix ...",
                    path_, said));
  }
  throw CorruptData("roads-unreadable",
                    fmt::format("{}: reading its features failed ({}); the file is cut off or damaged: fetch it again "
                                "and repeat the command",
                                path_, said));
}

PlanePolygon box_on_plane(const OGREnvelope& box, OGRCoordinateTransformation& to_plane, const std::string& path) {
  constexpr int kSteps = 64;
  std::vector<GridPoint> ring;
  const auto edge = [&](double x0, double y0, double x1, double y1) {
    for (int i = 0; i < kSteps; ++i) {
      double x = x0 + (x1 - x0) * i / kSteps;
      double y = y0 + (y1 - y0) * i / kSteps;
      const GdalMessages messages;
      if (to_plane.Transform(1, &x, &y) == FALSE || !std::isfinite(x) || !std::isfinite(y)) {
        throw InvalidInput(
            "crs-not-transformable",
            fmt::format("{}: its extent ({} {} to {} {}) has no place in the zone of the map; if the "
                        "reference system is wrong, give the right one with --crs, or cut it with --extent",
                        path, box.MinX, box.MinY, box.MaxX, box.MaxY));
      }
      ring.push_back({x, y});
    }
  };
  edge(box.MinX, box.MinY, box.MaxX, box.MinY);
  edge(box.MaxX, box.MinY, box.MaxX, box.MaxY);
  edge(box.MaxX, box.MaxY, box.MinX, box.MaxY);
  edge(box.MinX, box.MaxY, box.MinX, box.MinY);
  return PlanePolygon(ring);
}

LatLon centre_on_earth(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path,
                       std::string_view remedy) {
  const TransformationPtr to_earth = transformation(crs, wgs84_reference(), path);
  double lon = (box.MinX + box.MaxX) / 2.0;
  double lat = (box.MinY + box.MaxY) / 2.0;
  const GdalMessages messages;
  if (to_earth->Transform(1, &lon, &lat) == FALSE || !(std::abs(lat) <= 90.0) || !(std::abs(lon) <= 360.0)) {
    refuse_as_nowhere(path, remedy);
  }
  return {lat, lon};
}

void refuse_as_nowhere(const std::string& path, std::string_view remedy) {
  throw InvalidInput(
      "crs-not-transformable",
      fmt::format("{}: its coordinates have no place on Earth; if the reference system is wrong, {}", path, remedy));
}

OGREnvelope with_sides_of(const OGREnvelope& box, double side_m, OGRCoordinateTransformation& to_plane) {
  const GdalMessages messages;
  const double x = (box.MinX + box.MaxX) / 2.0;
  const double y = (box.MinY + box.MaxY) / 2.0;
  const double step = 1e-6 * std::max({1.0, std::abs(x), std::abs(y)});  // some metres, in degrees too
  std::array<double, 3> east{x, x + step, x};
  std::array<double, 3> north{y, y, y + step};
  OGREnvelope grown = box;
  if (to_plane.Transform(3, east.data(), north.data()) == FALSE) return grown;
  const auto grow = [&](std::size_t i, double& low, double& high) {
    const double metres_a_unit = std::hypot(east[i] - east[0], north[i] - north[0]) / step;
    const double margin = (side_m / metres_a_unit - (high - low)) / 2.0;
    if (!std::isfinite(margin) || margin <= 0.0) return;
    low -= margin;
    high += margin;
  };
  grow(1, grown.MinX, grown.MaxX);
  grow(2, grown.MinY, grown.MaxY);
  return grown;
}

}  // namespace roadfix
