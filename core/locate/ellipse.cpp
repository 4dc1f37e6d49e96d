#include "core/locate/ellipse.hpp"

#include <algorithm>
#include <cmath>

#include "core/locate/map_view.hpp"

namespace roadfix {

Ellipse on_grid(const Ellipse& ellipse, const UtmZone& zone, GridPoint at) {
  return {ellipse.sigma_m, zone.grid_from_true(ellipse.heading, at)};
}

Ellipse widened(const Ellipse& ellipse, double sigma_m) {
  return {{std::hypot(ellipse.sigma_m[0], sigma_m), std::hypot(ellipse.sigma_m[1], sigma_m)}, ellipse.heading};
}

PositionCovariance position_covariance(const std::array<double, 2>& variances, Angle axis) {
  const auto [along, across] = variances;
  const double s = sin(axis);
  const double c = cos(axis);
  return {along * s * s + across * c * c, (along - across) * s * c, along * c * c + across * s * s};
}

PositionCovariance position_covariance(const MapView& map, GridPoint at, const PoseCovariance& covariance) {
  const double registration_m = map.registration_sigma_m(at);
  const double registration2 = registration_m * registration_m;
  return {covariance[0][0] + registration2, covariance[0][1], covariance[1][1] + registration2};
}

double squared_mahalanobis(GridPoint mean, GridPoint point, const PositionCovariance& covariance) {
  const auto [east2, east_north, north2] = covariance;
  const double east = point.east_m - mean.east_m;
  const double north = point.north_m - mean.north_m;
  return (north2 * east * east - 2.0 * east_north * east * north + east2 * north * north) /
         (east2 * north2 - east_north * east_north);
}

Ellipse ellipse_of(const MapView& map, GridPoint at, const PoseCovariance& covariance) {
  const auto [east2, east_north, north2] = position_covariance(map, at, covariance);
  const double mean = 0.5 * (east2 + north2);
  const double split = std::hypot(0.5 * (north2 - east2), east_north);
  const Angle from_grid_north = Angle::radians(0.5 * std::atan2(2.0 * east_north, north2 - east2));
  const double true_deg = map.zone.true_from_grid(from_grid_north, at).compass_degrees();
  return {{std::sqrt(mean + split), std::sqrt(std::max(0.0, mean - split))},
          Angle::degrees(std::fmod(true_deg, 180.0))};
}

}  // namespace roadfix
