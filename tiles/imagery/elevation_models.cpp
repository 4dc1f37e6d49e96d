#include "tiles/imagery/elevation_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <string_view>

#include "core/grid/lattice.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "tiles/imagery/georeference.hpp"
#include "tiles/imagery/raster_file.hpp"
#include "tiles/imagery/warp.hpp"
#include "tiles/sources/exported_roads.hpp"

namespace roadfix {
namespace {

constexpr double kAroundM = 2000.0;
constexpr int kStepCells = 256;
constexpr float kHalf = 0.5F;

/// What makes metres above the sea of the stored values.
struct HeightScale {
  double factor = 1.0;
  double offset_m = 0.0;
};

struct Model {
  std::string path;
  std::optional<int> overview;  ///< to read in place of the full image
  HeightScale scale;
  double gsd_m = 0.0;  ///< of the full image
};

void require_heights(const RasterFile& file) {
  const bool roads = holds_exported_roads(file.dataset());
  if (!roads && file.channels() == 1 && file.first_band().GetRasterDataType() != GDT_Byte) return;
  throw InvalidInput(
      "elevation-not-heights",
      fmt::format("{}: it holds {}, not heights. Name an elevation model: one band of heights, of more than 8 bits "
                  "(gdal_translate -ot Int16 makes a copy of bytes that are heights)",
                  file.path(), roads ? "roads, as roadfix wrote them" : "a picture in colours or shades of grey"));
}

/// Of a 3D reference system, or of one with a vertical part that says so.
bool counts_from_ellipsoid(const OGRSpatialReference& crs) {
  if (crs.IsCompound() == FALSE) return crs.GetAxesCount() == 3;
  const char* datum = crs.GetAttrValue("VERT_DATUM");
  return datum != nullptr && lower_case(datum).find("ellipsoid") != std::string::npos;
}

void require_above_sea(const RasterFile& file) {
  if (!counts_from_ellipsoid(file.crs())) return;
  throw InvalidInput(
      "elevation-above-ellipsoid",
      fmt::format(
          "{}: its heights count from the ellipsoid, tens of metres beside the sea from which an autopilot "
          "counts. Convert it with a geoid where PROJ has its grid: gdalwarp -t_srs EPSG:4326+5773 {} above-sea.tif",
          file.path(), file.path()));
}

/// As programs and formats write it, in small letters; nullopt of others.
std::optional<double> metres_of(const std::string& unit) {
  constexpr std::array<std::string_view, 6> kMetres{"m", "metre", "metres", "meter", "meters", "[m]"};
  constexpr std::array<std::string_view, 4> kFeet{"ft", "foot", "feet", "international foot"};
  constexpr std::array<std::string_view, 6> kSurveyFeet{"ftus",           "us-ft",          "us survey foot",
                                                        "us survey feet", "us_survey_foot", "foot_us"};
  const auto is_of = [&](const auto& words) { return std::ranges::find(words, unit) != words.end(); };
  if (is_of(kMetres)) return 1.0;
  if (is_of(kFeet)) return 0.3048;
  return is_of(kSurveyFeet) ? std::optional(1200.0 / 3937.0) : std::nullopt;
}

/// Where the file says nothing, metres, as heights nearly always are but beside coordinates in feet.
double metres_of_unit(const RasterFile& file) {
  constexpr std::array<std::string_view, 4> kNothing{"", "unspecified", "unknown", "none"};
  constexpr std::string_view kSayUnit =
      "say whether they are metres or feet (gdal_edit.py -units m, or ft); turn other units into metres first";
  const std::string unit = lower_case(trimmed(file.first_band().GetUnitType()));
  const OGRSpatialReference& crs = file.crs();
  if (std::ranges::find(kNothing, unit) == kNothing.end()) {
    if (const std::optional<double> metres = metres_of(unit)) return *metres;
    throw InvalidInput(
        "elevation-unit-unknown",
        fmt::format("{}: its heights are in '{}', of which nothing is known: {}", file.path(), unit, kSayUnit));
  }
  if (crs.IsVertical() != FALSE) return crs.GetTargetLinearUnits("VERT_CS");
  const char* name = nullptr;
  if (crs.IsProjected() == FALSE || crs.GetLinearUnits(&name) == 1.0) return 1.0;
  throw InvalidInput(
      "elevation-unit-unknown",
      fmt::format("{}: its reference system {} counts in '{}', and nothing tells whether its heights do, "
                  "too: {}",
                  file.path(), crs_name(crs), name, kSayUnit));
}

HeightScale scale_of(const RasterFile& file) {
  const double metres = metres_of_unit(file);
  return {metres * file.first_band().GetScale(), metres * file.first_band().GetOffset()};
}

/// Size of the ground that a pixel covers at this place; nullopt where it has none in the model's reference system.
std::optional<double> gsd_at(const Georeference& georeference, GridPoint place) {
  constexpr double kApartM = 100.0;
  const cv::Point2d here(place.east_m, place.north_m);
  std::vector<cv::Point2d> points{here, here + cv::Point2d(kApartM, 0.0), here + cv::Point2d(0.0, kApartM)};
  georeference.to_pixels(points);
  const double pixels = std::sqrt(std::abs((points[1] - points[0]).cross(points[2] - points[0])));
  return pixels > 0.0 ? std::optional(kApartM / pixels) : std::nullopt;
}

void require_possible(const cv::Mat& heights, const cv::Mat& valid, const std::string& path) {
  if (cv::countNonZero(valid) == 0) return;
  double low = 0.0;
  double high = 0.0;
  cv::minMaxLoc(heights, &low, &high, nullptr, nullptr, valid);
  const HeightRange possible = Terrain::kHeights;
  if (low >= possible.lowest_m && high <= possible.highest_m) return;
  const double wrong_m = low < possible.lowest_m ? low : high;
  throw InvalidInput("elevation-impossible",
                     fmt::format("{}: it holds a height of {:.7g} m; those of ground are from {} to {:.0f} m. If that "
                                 "stands for nothing, say so (gdal_edit.py -a_nodata VALUE); if it is in feet, too "
                                 "(gdal_edit.py -units ft)",
                                 path, wrong_m, possible.lowest_m, possible.highest_m));
}

RasterPixels heights_in(RasterFile& file, cv::Rect window, const HeightScale& scale) {
  RasterPixels pixels = file.read_numbers(window);
  pixels.values.convertTo(pixels.values, CV_32F, scale.factor, scale.offset_m);
  require_possible(pixels.values, pixels.valid, file.path());
  return pixels;
}

Model looked_at(const std::string& path, UtmZone zone, const GridGeometry& geometry) {
  const RasterFile file(path, {});
  require_heights(file);
  require_above_sea(file);
  // One that has no place there cannot be fine enough to come first.
  const double gsd_m = gsd_at(Georeference(file, zone), geometry.box().centre()).value_or(kLattice.width_m());
  return {path, file.overview_for(geometry.cell_m / gsd_m), scale_of(file), gsd_m};
}

/// Adds what a model knows to tile after tile of the cells, and calls `step` after each. Returns whether that is
/// anything.
template <typename Step>
bool add(const Model& model, UtmZone zone, const GridGeometry& geometry, GroundNumbers& ground, const Step& step) {
  RasterFile file(model.path, {}, model.overview);
  const Georeference georeference(file, zone);
  const double gsd_m = gsd_at(georeference, geometry.box().centre()).value_or(model.gsd_m);
  bool any = false;
  const PlacedNumbers raster{georeference, file.size(), gsd_m, [&](cv::Rect window) {
                               RasterPixels pixels = heights_in(file, window, model.scale);
                               any = any || cv::countNonZero(pixels.valid) > 0;
                               return pixels;
                             }};
  const cv::Rect whole(0, 0, geometry.cols, geometry.rows);
  for (int row = 0; row < geometry.rows; row += kStepCells) {
    for (int col = 0; col < geometry.cols; col += kStepCells) {
      const cv::Rect part = cv::Rect(col, row, kStepCells, kStepCells) & whole;
      GroundNumbers numbers{ground.sums(part), ground.weights(part), geometry.cell_m};
      const LatticeIndex first{geometry.origin.col + col, geometry.origin.row + row};
      warp_into(raster, GridGeometry{geometry.cell_m, first, part.width, part.height}.box(), numbers);
      step();
    }
  }
  return any;
}

Terrain terrain_of(const GroundNumbers& ground, const GridGeometry& geometry) {
  Terrain terrain = Terrain::unknown(geometry);
  auto code = terrain.codes.begin();
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col, ++code) {
      const float known = ground.weights.at<float>(row, col);
      if (known >= kHalf) *code = Terrain::code_of(static_cast<double>(ground.sums.at<float>(row, col) / known));
    }
  }
  return terrain;
}

}  // namespace

GridGeometry terrain_geometry(const GridBox& ground, std::int64_t most_cells) {
  const GridBox box = intersection(grown(ground, kAroundM), kLattice);
  for (double cell_m = Terrain::kFinestCellM;; cell_m *= 2.0) {
    const GridGeometry geometry = GridGeometry::covering(box, cell_m);
    if (std::int64_t{geometry.cols} * geometry.rows <= most_cells) return geometry;
  }
}

ElevationReading read_elevation_models(const std::vector<std::string>& paths, UtmZone zone,
                                       const GridGeometry& geometry, const OnProgress& progress, std::stop_token stop) {
  std::vector<Model> models;
  for (const std::string& path : paths) models.push_back(looked_at(path, zone, geometry));
  std::ranges::stable_sort(models, {}, &Model::gsd_m);
  const auto steps_along = [](int cells) { return (cells + kStepCells - 1) / kStepCells; };
  const std::int64_t total = std::ssize(models) * steps_along(geometry.cols) * steps_along(geometry.rows);
  std::int64_t done = 0;
  const auto step = [&] {
    if (stop.stop_requested()) throw Interrupted("work-stopped", "stopped while elevation models were read");
    if (progress) progress(++done, total);
  };
  GroundNumbers ground{cv::Mat::zeros(geometry.rows, geometry.cols, CV_32FC1),
                       cv::Mat::zeros(geometry.rows, geometry.cols, CV_32FC1), geometry.cell_m};
  ElevationReading reading;
  for (const Model& model : models) {
    if (!add(model, zone, geometry, ground, step)) reading.beside.push_back(model.path);
  }
  reading.terrain = terrain_of(ground, geometry);
  if (std::ranges::all_of(reading.terrain.codes, [](std::uint16_t code) { return code == Terrain::kUnknown; })) {
    const LatLon place = zone.unproject(geometry.box().centre());
    throw InvalidInput("elevation-beyond-map",
                       fmt::format("no elevation model knows a height of the map's ground, around latitude {:.4f}, "
                                   "longitude {:.4f}: name those that do",
                                   place.lat_deg, place.lon_deg));
  }
  return reading;
}

}  // namespace roadfix
