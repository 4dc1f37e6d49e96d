// Map cells live in one UTM zone (WGS 84) per map; this ties the plane of core/units/planar to the Earth.
//
// Accuracy of the projection: about 5 nm within the zone, still below a millimetre 10 degrees off it (GeographicLib).
#pragma once

#include <optional>

#include "core/geodesy/latlon.hpp"
#include "core/units/angle.hpp"
#include "core/units/planar.hpp"

namespace roadfix {

/// A zone 1..60 and its hemisphere. False northing is 10,000 km in the south.
class UtmZone {
 public:
  /// Zone that contains the point. Throws InvalidInput for NaN, out-of-range values and the poles (|lat| beyond 84 N /
  /// 80 S).
  static UtmZone containing(LatLon point);
  /// EPSG:32601..32660 or 32701..32760; nullopt otherwise.
  static std::optional<UtmZone> from_epsg(int code);

  int number() const { return number_; }
  bool northern() const { return northern_; }
  int epsg() const { return (northern_ ? 32600 : 32700) + number_; }
  UtmZone southern() const { return {number_, false}; }

  /// Throws InvalidInput for NaN, out-of-range values and points so far off the zone that UTM is undefined.
  GridPoint project(LatLon point) const;
  /// nullopt where UTM is undefined. Throws InvalidInput for NaN and out-of-range values.
  std::optional<GridPoint> project_if_defined(LatLon point) const;
  LatLon unproject(GridPoint point) const;
  /// Bearing of grid north clockwise from true north at the point: true heading = grid heading + convergence.
  Angle convergence(GridPoint point) const;

  Angle grid_from_true(Angle true_heading, GridPoint at) const { return true_heading - convergence(at); }
  Angle true_from_grid(Angle grid_heading, GridPoint at) const { return grid_heading + convergence(at); }

  friend bool operator==(const UtmZone&, const UtmZone&) = default;

 private:
  UtmZone(int number, bool northern) : number_(number), northern_(northern) {}
  int number_;
  bool northern_;
};

}  // namespace roadfix
