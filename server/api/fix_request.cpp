#include "server/api/fix_request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/units/error.hpp"
#include "server/api/feature_request.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;
using nlohmann::json;

void require_together(const Fields& fields, std::initializer_list<const char*> names) {
  const bool any = std::ranges::any_of(names, [&](const char* name) { return fields.has(name); });
  for (const char* name : names) {
    if (any && !fields.has(name)) {
      throw InvalidField("missing-parameter", name,
                         fmt::format("'{}' is missing: give {} together", name, fmt::join(names, ", ")));
    }
  }
}

GeoPose parse_pose(const json& pose, std::size_t index) {
  const std::string place = fmt::format("poses[{}]", index);
  if (!pose.is_object() || pose.size() > 3) {
    throw InvalidField("bad-parameter", place, "a pose is an object with lat, lon and heading_deg");
  }
  return {{number_within(pose, "lat", place, kLatitude), number_within(pose, "lon", place, kLongitude)},
          Angle::degrees(number_within(pose, "heading_deg", place, kDegrees))};
}

/// Rounded up, since 0 means no proof.
std::chrono::milliseconds milliseconds_of(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(1000.0 * seconds)));
}

}  // namespace

const std::vector<std::string>& prior_fields() {
  static const std::vector<std::string> kFields{"lat", "lon", "radius_m", "bbox", "heading_deg", "heading_range_deg"};
  return kFields;
}

const std::vector<std::string>& fix_option_fields() {
  static const std::vector<std::string> kFields{"confidence", "max_modes", "scale_range", "proof_s", "time_limit_s"};
  return kFields;
}

Prior parse_prior(const Fields& fields) {
  Prior prior;
  require_together(fields, {"lat", "lon", "radius_m"});
  if (fields.has("lat")) {
    prior.circle = GeoCircle{{fields.number("lat", kLatitude), fields.number("lon", kLongitude)},
                             fields.number("radius_m", {0.0, 2e7, true})};
  }
  if (const auto box = fields.optional_numbers("bbox", 4)) {
    prior.box = told_box(std::span<const double, 4>(*box));
    if (!prior.box) {
      throw InvalidField("bad-parameter", "bbox",
                         "'bbox' must be west,south,east,north in degrees with south < north, and with west < east "
                         "unless the antimeridian lies between them");
    }
  }
  require_together(fields, {"heading_deg", "heading_range_deg"});
  if (fields.has("heading_deg")) {
    prior.heading = HeadingRange{Angle::degrees(fields.number("heading_deg", kDegrees)),
                                 Angle::degrees(fields.number("heading_range_deg", {0.0, 180.0}))};
  }
  return prior;
}

FixOptions parse_fix_options(const Fields& fields, const Limits& limits) {
  FixOptions options;
  options.confidence = fields.optional_number("confidence", kConfidence).value_or(options.confidence);
  options.search.max_modes = fields.optional_integer("max_modes", 1, limits.modes).value_or(options.search.max_modes);
  options.max_search_km2 = limits.search_km2;
  options.search.scale_range = fields.optional_number("scale_range", {0.0, kMaxScaleRange}).value_or(0.0);
  const double proof_s = fields.optional_number("proof_s", {0.0, 3600.0}).value_or(0.0);
  if (proof_s > 0.0) options.search.proof_time = milliseconds_of(proof_s);
  return options;
}

std::optional<std::chrono::milliseconds> parse_time_limit(const Fields& fields) {
  const auto limit_s = fields.optional_number("time_limit_s", {0.0, 3600.0, true});
  if (!limit_s) return std::nullopt;
  return milliseconds_of(*limit_s);
}

std::vector<GeoPose> parse_poses(const Fields& fields, const Limits& limits) {
  if (!fields.has("poses"))
    throw InvalidField("missing-parameter", "poses", "'poses' is missing; send JSON with a list of poses");
  const json* poses = fields.member("poses");
  if (poses == nullptr || !poses->is_array() || poses->empty()) {
    throw InvalidField("bad-parameter", "poses", "'poses' must be a list of at least one pose in a JSON body");
  }
  if (poses->size() > static_cast<std::size_t>(limits.poses)) {
    throw LimitExceeded("too-many-poses",
                        fmt::format("{} poses in one request; at most {} are allowed", poses->size(), limits.poses));
  }
  std::vector<GeoPose> parsed;
  parsed.reserve(poses->size());
  for (std::size_t i = 0; i < poses->size(); ++i) parsed.push_back(parse_pose((*poses)[i], i));
  return parsed;
}

}  // namespace roadfix::api
