#include "core/track/track_geometry.hpp"

#include <algorithm>
#include <cmath>

#include "core/locate/ellipse.hpp"
#include "core/match/footprint.hpp"

namespace roadfix {
namespace {

std::optional<Prior> prior_within(const MapView& map, const GridCircle& circle) {
  if (!contains(circle, nearest(map.extent, circle.centre))) return std::nullopt;
  Prior prior;
  prior.circle = GeoCircle{map.zone.unproject(circle.centre), circle.radius_m + 1.0};
  return prior;
}

}  // namespace

std::optional<Prior> prior_around(const MapView& map, const Particles& p) {
  std::vector<GridPoint> places;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.weight[i] > 0.0) places.push_back({p.east_m[i], p.north_m[i]});
  }
  const GridPoint centre = box_around(places).centre();
  double radius_m = 0.0;
  for (const GridPoint place : places) radius_m = std::max(radius_m, distance_m(centre, place));
  return prior_within(map, {centre, radius_m});
}

std::optional<Prior> prior_near(const MapView& map, const GridPose& pose, double radius_m, Angle heading_half_width) {
  std::optional<Prior> prior = prior_within(map, {pose.position, radius_m});
  if (prior) prior->heading = HeadingRange{on_earth(pose, map.zone).heading, heading_half_width};
  return prior;
}

std::optional<double> mean_agl_m(const MapView& map, const Particles& particles, double above_sea_m) {
  if (!map.terrain) return std::nullopt;
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.weight[i] <= 0.0) continue;
    const GridPoint place{particles.east_m[i], particles.north_m[i]};
    const auto agl_m = map.terrain->height_above_ground_m(place, above_sea_m);
    if (!agl_m) continue;
    sum += particles.weight[i] * *agl_m;
    weights += particles.weight[i];
  }
  if (weights <= 0.0) return std::nullopt;
  return sum / weights;
}

std::vector<Proposal> proposals_of(const MapView& map, const Fix& fix, const FeatureMap& features) {
  constexpr double kWiden = 4.0;
  const double cell_at_the_edge = 1.0 / footprint_reach(features);
  constexpr double kMinWeight = 0.02;
  std::vector<Proposal> proposals;
  for (const FixMode& mode : fix.modes) {
    const GridPose at = on_grid(mode.pose, map.zone);
    const Ellipse ellipse = on_grid(mode.ellipse, map.zone, at.position);
    const auto variance = [&](double sigma_m) { return kWiden * sigma_m * sigma_m + 1.0; };
    const PositionCovariance place =
        position_covariance({variance(ellipse.sigma_m[0]), variance(ellipse.sigma_m[1])}, ellipse.heading);
    const double turn2 = kWiden * std::pow(mode.heading_sigma.radians(), 2.0) + 1e-4;
    proposals.push_back(
        {at,
         {{{place.east_east, place.east_north, 0.0}, {place.east_north, place.north_north, 0.0}, {0.0, 0.0, turn2}}},
         std::max(mode.weight, kMinWeight),
         std::log(mode.scale),
         std::sqrt(kWiden) * cell_at_the_edge});
  }
  return proposals;
}

TrackCluster to_geographic(const MapView& map, const Cluster& cluster, double nadir_sigma_m) {
  const double scale = std::exp(cluster.log_scale);
  const double nadir_m = scale * nadir_sigma_m;
  const double told95_m = kSigmasOf95 * std::hypot(map.registration_sigma_m(cluster.mean.position), nadir_m);
  return {on_earth(cluster.mean, map.zone),
          cluster.weight,
          widened(ellipse_of(map, cluster.mean.position, cluster.covariance), nadir_m),
          Angle::radians(std::sqrt(cluster.covariance[2][2])),
          std::hypot(cluster.radius95_m, told95_m),
          scale,
          scale * cluster.log_scale_sigma};
}

}  // namespace roadfix
