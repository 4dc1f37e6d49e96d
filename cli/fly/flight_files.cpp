#include "cli/fly/flight_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>
#include <vector>

#include "core/locate/ellipse.hpp"
#include "server/api/geojson.hpp"

namespace roadfix::fly {
namespace {

using nlohmann::json;

PositionCovariance covariance_of(const Ellipse& ellipse) {
  const auto& [along, across] = ellipse.sigma_m;
  return position_covariance({along * along, across * across}, ellipse.heading);
}

json ellipse(const Record& record, const UtmZone& zone) {
  constexpr int kCorners = 36;
  const auto& [sigma, axis] = on_grid(record.estimate.clusters.front().ellipse, zone, record.best.position);
  std::vector<LatLon> ring;
  for (int i = 0; i <= kCorners; ++i) {
    // Against the clock, as GeoJSON wants its outer rings.
    const double t = -2.0 * std::numbers::pi * (i % kCorners) / kCorners;
    const double along = kSigmasOf95 * sigma[0] * std::cos(t);
    const double across = kSigmasOf95 * sigma[1] * std::sin(t);
    ring.push_back(zone.unproject({record.best.position.east_m + along * sin(axis) + across * cos(axis),
                                   record.best.position.north_m + along * cos(axis) - across * sin(axis)}));
  }
  return api::polygon_json(ring);
}

json feature(json geometry, json properties) {
  return {{"type", "Feature"}, {"geometry", std::move(geometry)}, {"properties", std::move(properties)}};
}

json line(const std::vector<LatLon>& places, const std::string& what, const std::string& filter, const Run& run) {
  return feature(api::line_json(places), {{"what", what}, {"filter", filter}, {"seed", run.seed}});
}

std::string_view reason_of(const TrackEstimate& estimate) {
  return estimate.unclaimed ? word_of(kUnclaimed, *estimate.unclaimed) : std::string_view();
}

}  // namespace

std::string csv_header() {
  return "seed,filter,step,time_s,true_lat,true_lon,true_heading_deg,lat,lon,heading_deg,error_m,heading_error_deg,"
         "weight,converged,reason,sigma_major_m,sigma_minor_m,ellipse_heading_deg,heading_sigma_deg,cov_ee_m2,"
         "cov_en_m2,cov_nn_m2,clusters,particles,measurement,doubt,resets,scale,scale_sigma,step_ms\n";
}

std::string csv_lines(const std::string& filter, const Run& run, const UtmZone& zone) {
  std::string lines;
  for (const Record& r : run.records) {
    const TrackCluster& best = r.estimate.clusters.front();
    const LatLon truth = zone.unproject(r.truth.position);
    const PositionCovariance covariance = covariance_of(best.ellipse);
    lines += fmt::format(
        "{},{},{},{:.3f},{:.8f},{:.8f},{:.3f},{:.8f},{:.8f},{:.3f},{:.3f},{:.3f},{:.5f},{},{},{:.3f},{:.3f},{:.2f},"
        "{:.3f},{:.4f},{:.4f},{:.4f},{},{},{},{:.4f},{},{:.5f},{:.5f},{:.3f}\n",
        run.seed, filter, r.sequence, r.time_s, truth.lat_deg, truth.lon_deg,
        zone.true_from_grid(r.truth.heading, r.truth.position).compass_degrees(), best.pose.position.lat_deg,
        best.pose.position.lon_deg, best.pose.heading.compass_degrees(), r.error_m, r.heading_error_deg, best.weight,
        r.estimate.converged() ? 1 : 0, reason_of(r.estimate), best.ellipse.sigma_m[0], best.ellipse.sigma_m[1],
        best.ellipse.heading.degrees(), best.heading_sigma.degrees(), covariance.east_east, covariance.east_north,
        covariance.north_north, r.estimate.cluster_count, r.estimate.particles,
        word_of(kMeasurements, r.estimate.measurement), r.estimate.doubt, r.estimate.resets, best.scale,
        best.scale_sigma, r.step_ms);
  }
  return lines;
}

json geojson_features(const std::string& filter, const Run& run, const UtmZone& zone) {
  json features = json::array();
  std::vector<LatLon> truth;
  std::vector<LatLon> claimed;
  for (const Record& record : run.records) {
    truth.push_back(zone.unproject(record.truth.position));
    if (!record.estimate.converged()) continue;
    claimed.push_back(zone.unproject(record.best.position));
    features.push_back(feature(ellipse(record, zone), {{"what", "ellipse95"},
                                                       {"filter", filter},
                                                       {"seed", run.seed},
                                                       {"step", record.sequence},
                                                       {"error_m", record.error_m}}));
  }
  if (truth.size() > 1) features.push_back(line(truth, "truth", filter, run));
  if (claimed.size() > 1) features.push_back(line(claimed, "estimate", filter, run));
  return features;
}

}  // namespace roadfix::fly
