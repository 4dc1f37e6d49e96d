#include "tiles/sources/position_error.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace roadfix {
namespace {

/// 4 m of the satellite's own, and relief of 20 m seen at a slant of 25 degrees.
constexpr double kRpcSigmaM = 10.0;

/// Points that GDAL's polynomial fits exactly: of first order, of second where it has as many.
constexpr int kExactFirstOrder = 3;
constexpr int kExactSecondOrder = 6;

double control_point_sigma_m(const RasterFile& file, const Georeference& georeference, UtmZone zone) {
  GDALDataset& dataset = file.dataset();
  const int count = dataset.GetGCPCount();
  const int exact = count >= kExactSecondOrder ? kExactSecondOrder : kExactFirstOrder;
  if (count <= exact) return 0.0;
  const TransformationPtr to_zone = transformation(file.crs(), utm_reference(zone), file.path());
  double squares = 0.0;
  for (int i = 0; i < count; ++i) {
    const GDAL_GCP& point = dataset.GetGCPs()[i];
    std::vector<cv::Point2d> fitted{{point.dfGCPPixel, point.dfGCPLine}};
    georeference.to_plane(fitted);
    double east = point.dfGCPX;
    double north = point.dfGCPY;
    if (to_zone->Transform(1, &east, &north) == FALSE) return std::numeric_limits<double>::infinity();
    const cv::Point2d miss = fitted[0] - cv::Point2d(east, north);
    squares += miss.dot(miss);
  }
  return std::sqrt(squares / (2.0 * (count - exact)));
}

PositionError error_of_placing(const RasterFile& file, const Georeference& georeference, UtmZone zone) {
  std::array<double, 6> transform{};
  if (file.dataset().GetGeoTransform(transform.data()) == CE_None) return {};
  if (file.dataset().GetGCPCount() > 0) {
    const double sigma_m = control_point_sigma_m(file, georeference, zone);
    return {sigma_m, fmt::format("{}: its {} control points contradict each other by {:.3g} m (1 sigma), and so "
                                 "uncertain is where it lies. Correct them, or make an orthoimage of it first",
                                 file.path(), file.dataset().GetGCPCount(), sigma_m)};
  }
  return {kRpcSigmaM,
          fmt::format("{}: placed by its rational polynomials at the mean height of the scene, which is taken to "
                      "be uncertain by {} m (1 sigma), more where hills are. Make an orthoimage of it first: gdalwarp "
                      "-rpc -to RPC_DEM=terrain.tif",
                      file.path(), kRpcSigmaM)};
}

bool known_to(double accuracy_m, const OGRSpatialReference& from, const OGRSpatialReference& to, LatLon place) {
  constexpr double kAroundDeg = 0.05;
  const GdalMessages messages;
  OGRCoordinateTransformationOptions options;
  options.SetBallparkAllowed(false);
  options.SetDesiredAccuracy(accuracy_m);
  options.SetAreaOfInterest(place.lon_deg - kAroundDeg, place.lat_deg - kAroundDeg, place.lon_deg + kAroundDeg,
                            place.lat_deg + kAroundDeg);
  return TransformationPtr(OGRCreateCoordinateTransformation(&from, &to, options)) != nullptr;
}

}  // namespace

PositionError datum_error(const OGRSpatialReference& reference, UtmZone zone, LatLon place, const std::string& path) {
  constexpr double kUsualM = 9.0;  // of most surveys the registry states 1 to 7 m
  constexpr std::array<double, 5> kStatedM{10.0, 15.0, 20.0, 35.0, 50.0};
  if (!on_old_ellipsoid(reference)) return {};
  const OGRSpatialReference plane = utm_reference(zone);
  if (known_to(kUsualM, reference, plane, place)) return {};
  for (const double stated_m : kStatedM) {
    if (!known_to(stated_m, reference, plane, place)) continue;
    return {stated_m, fmt::format("{}: the way from its reference system {} to WGS 84 is known to {:g} m only, and so "
                                  "uncertain is where it lies (1 sigma). With the grids of its survey (Debian: "
                                  "proj-data) it may be known better; where you have checked it, give "
                                  "--registration-sigma",
                                  path, crs_name(reference), stated_m)};
  }
  return {};
}

PositionError position_error(const RasterFile& file, const Georeference& georeference, UtmZone zone) {
  PositionError placing = error_of_placing(file, georeference, zone);
  if (!on_old_ellipsoid(file.crs())) return placing;
  PositionError datum = datum_error(file.crs(), zone, centre_of(file), file.path());
  return datum.sigma_m > placing.sigma_m ? datum : placing;
}

}  // namespace roadfix
