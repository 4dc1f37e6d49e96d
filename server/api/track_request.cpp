#include "server/api/track_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/units/error.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/fix_request.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;

VehicleNoise parse_vehicle(const Fields& fields) {
  VehicleNoise noise;
  if (const auto speed = fields.optional_number("speed_m_s", {-300.0, 300.0})) {
    VehicleNoise::Planar planar;
    planar.speed_m_s = {*speed, fields.optional_number("speed_sigma_m_s", {0.0, 300.0}).value_or(2.0)};
    planar.turn_rate_rad_s = {
        fields.optional_angle("turn_rate_deg_s", kDegrees).value_or(Angle()).radians(),
        fields.optional_angle("turn_rate_sigma_deg_s", {0.0, 360.0}).value_or(Angle::degrees(5.0)).radians()};
    noise.planar = planar;
  } else {
    for (const char* name : {"speed_sigma_m_s", "turn_rate_deg_s", "turn_rate_sigma_deg_s"}) {
      if (!fields.has(name)) continue;
      throw InvalidField("missing-parameter", "speed_m_s", fmt::format("'{}' goes with speed_m_s", name));
    }
  }
  noise.odometry_share = fields.optional_number("odometry_share", {0.0, 1.0}).value_or(noise.odometry_share);
  noise.wind.sigma_m_s = fields.optional_number("wind_sigma_m_s", {0.0, 100.0}).value_or(noise.wind.sigma_m_s);
  noise.scale_range = fields.optional_number("scale_range", {0.0, kMaxScaleRange}).value_or(noise.scale_range);
  noise.nadir_sigma_m = told_nadir_sigma_m(fields);
  return noise;
}

Odometry parse_odometry(const Fields& fields) {
  return {fields.number("forward_m", kMovement), fields.number("right_m", kMovement),
          Angle::degrees(fields.number("turn_deg", kDegrees)).wrapped()};
}

bool is_start_known(const Fields& fields) {
  if (!fields.flag("known_start")) return false;
  if (!fields.has("radius_m")) {
    throw InvalidField("missing-parameter", "radius_m", "'known_start' goes with lat, lon and radius_m");
  }
  fields.number("radius_m", {0.0, Reach::kMaxM});
  return true;
}

}  // namespace

const std::vector<std::string>& track_members() {
  static const std::vector<std::string> kMembers =
      joined({{"map"},
              prior_fields(),
              {"known_start"},
              {"particles", "seed"},
              {"speed_m_s", "speed_sigma_m_s", "turn_rate_deg_s", "turn_rate_sigma_deg_s", "odometry_share"},
              {"wind_sigma_m_s", "scale_range", "nadir_sigma_m"}});
  return kMembers;
}

TrackRequest parse_track(const Fields& fields, const Limits& limits) {
  TrackRequest request{fields.text("map"), {}};
  TrackSettings& settings = request.settings;
  const int particles =
      fields.optional_integer("particles", 100, limits.particles).value_or(std::min(10'000, limits.particles));
  settings.filter.max_particles = particles;
  settings.filter.min_particles = std::min(settings.filter.min_particles, particles);
  settings.prior = parse_prior(fields);
  settings.start_is_known = is_start_known(fields);
  settings.vehicle = parse_vehicle(fields);
  settings.seed =
      static_cast<std::uint64_t>(fields.optional_integer("seed", 0, std::numeric_limits<int>::max()).value_or(1));
  settings.max_search_km2 = limits.search_km2;
  return request;
}

const std::vector<std::string>& step_fields() {
  static const std::vector<std::string> kFields{"sequence", "time_us",  "forward_m",
                                                "right_m",  "turn_deg", "covariance"};
  return kFields;
}

StepInput parse_step(const Fields& fields) {
  StepInput step;
  step.sequence = fields.large_integer("sequence", 0);
  step.time_us = fields.large_integer("time_us", 0);
  if (fields.has("forward_m") || fields.has("right_m") || fields.has("turn_deg"))
    step.odometry = parse_odometry(fields);
  if (const auto values = fields.optional_numbers("covariance", 9)) {
    if (!step.odometry) {
      throw InvalidField("missing-parameter", "forward_m", "'covariance' goes with forward_m, right_m and turn_deg");
    }
    OdometryCovariance covariance{};
    for (std::size_t i = 0; i < 9; ++i) covariance[i / 3][i % 3] = (*values)[i];
    step.covariance = covariance;
  }
  return step;
}

}  // namespace roadfix::api
