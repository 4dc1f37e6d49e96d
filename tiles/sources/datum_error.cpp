#include "tiles/sources/datum_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>

#include "core/units/error.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

/// Whether there is a way around the place, and of that accuracy if one is given.
bool has_way(const OGRSpatialReference& from, const OGRSpatialReference& to, LatLon place,
             std::optional<double> accuracy_m = {}) {
  constexpr double kAroundDeg = 0.05;
  const GdalMessages messages;
  OGRCoordinateTransformationOptions options;
  options.SetBallparkAllowed(false);
  if (accuracy_m) options.SetDesiredAccuracy(*accuracy_m);
  options.SetAreaOfInterest(place.lon_deg - kAroundDeg, place.lat_deg - kAroundDeg, place.lon_deg + kAroundDeg,
                            place.lat_deg + kAroundDeg);
  return TransformationPtr(OGRCreateCoordinateTransformation(&from, &to, options)) != nullptr;
}

}  // namespace

PositionError datum_error(const OGRSpatialReference& reference, UtmZone zone, LatLon place, const std::string& path) {
  constexpr double kNothingM = 2.0;
  constexpr std::array<double, 9> kStatedM{3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 25.0, 35.0, 50.0};
  assert(on_old_ellipsoid(reference));
  const OGRSpatialReference plane = utm_reference(zone);
  if (has_way(reference, plane, place, kNothingM)) return {};
  if (!has_way(reference, plane, place)) {
    // GDAL would take a way that is meant for elsewhere, or leave the datum as it is, without a word.
    throw InvalidInput("datum-unknown",
                       fmt::format("{}: no way from the datum of its reference system {} to WGS 84 is known around "
                                   "latitude {:.2f} and longitude {:.2f}, so the roads could be hundreds of metres "
                                   "off: {}; a PROJ string with +towgs84 will do, too",
                                   path, crs_name(reference), place.lat_deg, place.lon_deg, kGiveRightCrs));
  }
  const auto stated_m = std::ranges::partition_point(
      kStatedM, [&](double accuracy_m) { return !has_way(reference, plane, place, accuracy_m); });
  if (stated_m == kStatedM.end()) return {};
  return {*stated_m, fmt::format("{}: the way from its reference system {} to WGS 84 is known to {:g} m only, and so "
                                 "uncertain is where it lies (1 sigma). With the grids of its survey (Debian: "
                                 "proj-data) it may be known better; where you have checked it, give "
                                 "--registration-sigma",
                                 path, crs_name(reference), *stated_m)};
}

}  // namespace roadfix
