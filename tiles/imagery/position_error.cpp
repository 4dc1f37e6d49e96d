#include "tiles/imagery/position_error.hpp"

#include <cpl_port.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/units/error.hpp"
#include "tiles/imagery/geotransform.hpp"

namespace roadfix {
namespace {

/// 4 m of the satellite's own, and relief of 20 m seen at a slant of 25 degrees.
constexpr double kRpcSigmaM = 10.0;

/// Of control points where an error of one would not show.
constexpr double kUncheckedSigmaM = 10.0;

/// Of coordinates that are rounded to steps of a second and of a thousandth of a degree (the root of a twelfth of
/// them).
constexpr double kSecondSigmaM = 9.0;
constexpr double kThousandthSigmaM = 32.0;

/// From how many points on GDAL fits a polynomial of second order to them, of first to fewer.
constexpr int kSecondOrderPoints = 6;

/// The terms of that polynomial at each point, when one of the points is left out.
cv::Mat polynomial_terms(const RasterFile& file) {
  const GDAL_GCP* points = file.dataset().GetGCPs();
  const int count = file.dataset().GetGCPCount();
  cv::Mat terms(count, count > kSecondOrderPoints ? 6 : 3, CV_64FC1);
  for (int i = 0; i < count; ++i) {
    const double u = points[i].dfGCPPixel / file.size().width - 0.5;
    const double v = points[i].dfGCPLine / file.size().height - 0.5;
    const std::array<double, 6> all{1.0, u, v, u * u, u * v, v * v};
    std::copy_n(all.begin(), terms.cols, terms.ptr<double>(i));
  }
  return terms;
}

struct PointErrors {
  double sigma_m = 0.0;
  bool all_checked = true;  ///< false where an error of some point would not show
};

/// How far control points lie from where the others put them, each left out of the fit in turn (PRESS: Allen, 1974). A
/// fit to all of them goes through few points whatever is wrong with one.
PointErrors control_point_errors(const RasterFile& file, UtmZone zone) {
  constexpr double kNone = 1e-6;
  const GDAL_GCP* points = file.dataset().GetGCPs();
  const int count = file.dataset().GetGCPCount();
  cv::Mat places(count, 2, CV_64FC1);
  for (int i = 0; i < count; ++i) {
    places.at<double>(i, 0) = points[i].dfGCPX - points[0].dfGCPX;
    places.at<double>(i, 1) = points[i].dfGCPY - points[0].dfGCPY;
  }
  const cv::Mat u = cv::SVD(polynomial_terms(file)).u;
  const cv::Mat residuals = places - u * (u.t() * places);
  const TransformationPtr to_zone = transformation(file.crs(), utm_reference(zone), file.path());
  double squares = 0.0;
  int checked = 0;
  for (int i = 0; i < count; ++i) {
    const double share_of_others = 1.0 - u.row(i).dot(u.row(i));  // in where the fit puts it
    if (share_of_others < kNone) continue;
    std::array<double, 2> east{points[i].dfGCPX, points[i].dfGCPX - residuals.at<double>(i, 0) / share_of_others};
    std::array<double, 2> north{points[i].dfGCPY, points[i].dfGCPY - residuals.at<double>(i, 1) / share_of_others};
    if (to_zone->Transform(2, east.data(), north.data()) == FALSE) return {std::numeric_limits<double>::infinity()};
    squares += std::pow(east[1] - east[0], 2) + std::pow(north[1] - north[0], 2);
    ++checked;
  }
  return {checked > 0 ? std::sqrt(squares / (2.0 * checked)) : 0.0, checked == count};
}

PositionError error_of_control_points(const RasterFile& file, UtmZone zone) {
  const int count = file.dataset().GetGCPCount();
  const PointErrors errors = control_point_errors(file, zone);
  if (!errors.all_checked && errors.sigma_m < kUncheckedSigmaM) {
    return {kUncheckedSigmaM,
            fmt::format("{}: its {} control points are so few, or lie so, that an error of one would not show, and "
                        "where it lies is taken to be uncertain by {} m (1 sigma). Give it more of them, or make an "
                        "orthoimage of it first; where you have checked it, give --registration-sigma",
                        file.path(), count, kUncheckedSigmaM)};
  }
  return {errors.sigma_m, fmt::format("{}: its {} control points contradict each other by {:.3g} m (1 sigma), and so "
                                      "uncertain is where it lies. Correct them, or make an orthoimage of it first",
                                      file.path(), count, errors.sigma_m)};
}

/// NITF tells its corners in coarse steps of degrees, unless a segment for it (BLOCKA) tells them again. Copies in
/// other formats keep these words, whether they lie there or were placed anew.
PositionError error_of_rounded_corners(const RasterFile& file) {
  GDALDataset& dataset = file.dataset();
  const char* coordinates = dataset.GetMetadataItem("NITF_ICORDS");
  if (!EQUAL(dataset.GetDriverName(), "NITF") || coordinates == nullptr) return {};
  if (dataset.GetMetadataItem("NITF_BLOCKA_BLOCK_COUNT") != nullptr) return {};
  const bool seconds = EQUAL(coordinates, "G") || EQUAL(coordinates, "C");
  if (!seconds && !EQUAL(coordinates, "D")) return {};
  const double sigma_m = seconds ? kSecondSigmaM : kThousandthSigmaM;
  return {sigma_m,
          fmt::format("{}: as NITF it tells its corners to {} only, and so uncertain is where it lies ({} m, 1 sigma). "
                      "Get it as GeoTIFF from its maker, since a copy that is made of this file lies no better; where "
                      "you have checked it, give --registration-sigma",
                      file.path(), seconds ? "a second" : "a thousandth of a degree", sigma_m)};
}

PositionError error_of_placing(const RasterFile& file, UtmZone zone) {
  const bool has_transform = geotransform_of(file.dataset()).has_value();
  const bool has_points = !has_transform && file.dataset().GetGCPCount() > 0;
  PositionError placing = has_points ? error_of_control_points(file, zone) : PositionError{};
  PositionError corners = error_of_rounded_corners(file);
  if (corners.sigma_m > placing.sigma_m) placing = std::move(corners);
  if (file.dataset().GetMetadata("RPC") == nullptr || placing.sigma_m >= kRpcSigmaM) return placing;
  if (has_transform || has_points) {
    return {
        kRpcSigmaM,
        fmt::format("{}: has rational polynomials beside its coordinates, as pictures have that are no orthoimages, "
                    "and where it lies is taken to be uncertain by {} m (1 sigma), more where hills are. Make an "
                    "orthoimage of it first: gdalwarp -rpc -to RPC_DEM=terrain.tif. If it is one, give "
                    "--registration-sigma",
                    file.path(), kRpcSigmaM)};
  }
  return {kRpcSigmaM,
          fmt::format("{}: placed by its rational polynomials at the mean height of the scene, which is taken to "
                      "be uncertain by {} m (1 sigma), more where hills are. Make an orthoimage of it first: gdalwarp "
                      "-rpc -to RPC_DEM=terrain.tif",
                      file.path(), kRpcSigmaM)};
}

}  // namespace

PositionErrors position_errors(const RasterFile& file, UtmZone zone) {
  PositionErrors errors{error_of_placing(file, zone), {}};
  if (on_old_ellipsoid(file.crs())) errors.datum = datum_error(file.crs(), zone, centre_of(file), file.path());
  return errors;
}

}  // namespace roadfix
