// Does the ground come out where it is? The pictures are ramps that grow with east or north, written through formulas
// of their own (GeographicLib, the sphere of Web Mercator), so a value tells its place.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <ostream>

#include "core/geodesy/utm.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/sources/place.hpp"
#include "tests/tiles/sources/test_raster.hpp"
#include "tiles/imagery/mosaic.hpp"

namespace roadfix {
namespace {

using testing::around;
using testing::kCentre;
using testing::kZone;
using testing::RasterSpec;
using testing::write_raster;

constexpr double kRampM = 200.0;

double east_ramp(GridPoint p) { return 127.5 + (p.east_m - kCentre.east_m) / kRampM * 255.0; }
double north_ramp(GridPoint p) { return 127.5 + (p.north_m - kCentre.north_m) / kRampM * 255.0; }

/// How a raster says where it lies: each of them says what the transform says.
enum class Reference { kTransform, kControlPoints, kRpc };

struct Crs {
  const char* name;
  int epsg;
  std::array<double, 6> transform;
  GridPoint (*plane)(double x, double y);  ///< from the raster's own coordinates
  Reference reference = Reference::kTransform;

  friend std::ostream& operator<<(std::ostream& out, const Crs& crs) { return out << crs.name; }
};

GridPoint from_degrees(double lon, double lat) { return kZone.project({lat, lon}); }
GridPoint from_web_mercator(double x, double y) {
  constexpr double kRadius = 6378137.0;
  const double lat = 2.0 * std::atan(std::exp(y / kRadius)) - std::numbers::pi / 2.0;
  return from_degrees(x / kRadius * 180.0 / std::numbers::pi, lat * 180.0 / std::numbers::pi);
}
GridPoint from_plane(double x, double y) { return {x, y}; }
GridPoint from_other_zone(double x, double y) {
  const UtmZone next = *UtmZone::from_epsg(32636);
  return kZone.project(next.unproject({x, y}));
}

std::vector<Crs> reference_systems() {
  const LatLon centre = kZone.unproject(kCentre);
  constexpr double kRadius = 6378137.0;
  const double x = centre.lon_deg * std::numbers::pi / 180.0 * kRadius;
  const double y = std::asinh(std::tan(centre.lat_deg * std::numbers::pi / 180.0)) * kRadius;
  const GridPoint next = UtmZone::from_epsg(32636)->project(centre);
  return {{"Utm", 32637, around(kCentre.east_m, kCentre.north_m, 1.0, 1.0, 0.0), from_plane},
          {"UtmRotated", 32637, around(kCentre.east_m, kCentre.north_m, 1.0, 1.0, 33.0), from_plane},
          {"UtmSouthUp", 32637, around(kCentre.east_m, kCentre.north_m, 1.0, -1.0, 0.0), from_plane},
          {"OtherZone", 32636, around(next.east_m, next.north_m, 1.0, 1.0, 0.0), from_other_zone},
          {"WebMercator", 3857, around(x, y, 1.27, 1.27, 0.0), from_web_mercator},
          {"Degrees", 4326, around(centre.lon_deg, centre.lat_deg, 1.14e-5, 0.9e-5, 0.0), from_degrees},
          {"ControlPoints", 32637, around(kCentre.east_m, kCentre.north_m, 1.0, 1.0, -20.0), from_plane,
           Reference::kControlPoints},
          {"Rpc", 4326, around(centre.lon_deg, centre.lat_deg, 1.14e-5, 0.9e-5, 0.0), from_degrees, Reference::kRpc}};
}

std::vector<std::array<double, 4>> corners(const std::array<double, 6>& t) {
  std::vector<std::array<double, 4>> points;
  for (const double row : {0.0, 300.0}) {
    for (const double col : {0.0, 300.0}) {
      points.push_back({col, row, t[0] + col * t[1] + row * t[2], t[3] + col * t[4] + row * t[5]});
    }
  }
  return points;
}

/// Rational polynomials without curvature that say what the north-up transform in degrees says. Their pixels are
/// counted from the centre of the first one (NGA STDI-0002, RPC00B).
std::vector<std::string> rational_polynomials(const std::array<double, 6>& t) {
  const auto term = [](const std::string& name, std::size_t place, int value) {
    std::string text = name + "=";
    for (std::size_t i = 0; i < 20; ++i) text += i == place ? std::to_string(value) + " " : "0 ";
    return text;
  };
  std::string line = term("LINE_NUM_COEFF", 2, -1);
  line.replace(line.find("-1 0") + 3, 1, "0.2");
  const auto number = [](const std::string& name, double value) { return fmt::format("{}={:.12f}", name, value); };
  return {number("LINE_OFF", 149.5),
          number("SAMP_OFF", 149.5),
          number("LINE_SCALE", 150.0),
          number("SAMP_SCALE", 150.0),
          number("LAT_OFF", t[3] + 150.0 * t[5]),
          number("LONG_OFF", t[0] + 150.0 * t[1]),
          number("LAT_SCALE", -150.0 * t[5]),
          number("LONG_SCALE", 150.0 * t[1]),
          number("HEIGHT_OFF", 700.0),
          number("HEIGHT_SCALE", 500.0),
          line,
          term("LINE_DEN_COEFF", 0, 1),
          term("SAMP_NUM_COEFF", 1, 1),
          term("SAMP_DEN_COEFF", 0, 1)};
}

class Position : public ::testing::TestWithParam<Crs> {};

TEST_P(Position, IsRightToATenthOfACell) {
  const Crs crs = GetParam();
  const testing::TemporaryFolder folder;
  RasterSpec spec{.width = 300, .height = 300, .bands = 3, .epsg = crs.epsg, .transform = crs.transform};
  if (crs.reference == Reference::kControlPoints) spec.control_points = corners(crs.transform);
  if (crs.reference == Reference::kRpc) spec.rpc = rational_polynomials(crs.transform);
  const std::string path = write_raster(folder / "a.tif", spec, [&](int band, int col, int row) {
    const std::array<double, 6>& t = crs.transform;
    const double x = t[0] + (col + 0.5) * t[1] + (row + 0.5) * t[2];
    const double y = t[3] + (col + 0.5) * t[4] + (row + 0.5) * t[5];
    const GridPoint p = crs.plane(x, y);
    const auto at_end = [](int place) { return place < 8 || place >= 292; };
    if (at_end(col) && at_end(row)) return 100.0 + 9.0 * ((col + row) % 2);  // no painted corner
    return band == 1 ? std::round(east_ramp(p)) : std::round(north_ramp(p));
  });
  const Mosaic mosaic({path}, {}, ValueRule::kPicture, kZone);
  EXPECT_NEAR(mosaic.gsd_m(), 1.0, 0.02);
  for (const double gsd : {0.5, 1.0, 4.0}) {
    const GridBox box{{kCentre.east_m - 96.0, kCentre.north_m - 96.0}, {kCentre.east_m + 96.0, kCentre.north_m + 96.0}};
    const GroundImage view = mosaic.view(box, gsd);
    ASSERT_EQ(cv::countNonZero(view.observed), view.observed.total());
    double east_error = 0.0;
    double north_error = 0.0;
    for (int row = 0; row < view.pixels.rows; ++row) {
      for (int col = 0; col < view.pixels.cols; ++col) {
        const GridPoint p{box.min.east_m + (col + 0.5) * gsd, box.max.north_m - (row + 0.5) * gsd};
        const cv::Vec3b pixel = view.pixels.at<cv::Vec3b>(row, col);
        east_error += (pixel[2] - east_ramp(p)) * kRampM / 255.0;
        north_error += (pixel[0] - north_ramp(p)) * kRampM / 255.0;
        ASSERT_NEAR(pixel[2], east_ramp(p), 1.6) << "gsd " << gsd << " column " << col << " row " << row;
        ASSERT_NEAR(pixel[0], north_ramp(p), 1.6) << "gsd " << gsd << " column " << col << " row " << row;
      }
    }
    // Means of whole numbers are rounded: up to half a step of the ramp.
    const double step_m = kRampM / 255.0;
    const double tolerance_m = gsd > 1.0 ? 0.5 * step_m : 0.2;
    EXPECT_NEAR(east_error / static_cast<double>(view.pixels.total()), 0.0, tolerance_m) << "gsd " << gsd;
    EXPECT_NEAR(north_error / static_cast<double>(view.pixels.total()), 0.0, tolerance_m) << "gsd " << gsd;
  }
}

INSTANTIATE_TEST_SUITE_P(ReferenceSystems, Position, ::testing::ValuesIn(reference_systems()),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace roadfix
