// The prior of a fix, its options, and the poses of a match, as a client gives them.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "core/locate/fix.hpp"
#include "server/api/fields.hpp"
#include "server/api/limits.hpp"

namespace roadfix::api {

/// That a client may ask of a fix.
inline constexpr Range kConfidence{0.5, 0.999999};

const std::vector<std::string>& prior_fields();
/// lat, lon, radius_m; bbox = west, south, east, north; heading_deg with heading_range_deg (half the width). None of
/// them = the whole map.
Prior parse_prior(const Fields& fields);

const std::vector<std::string>& fix_option_fields();
/// Those but the time limit, and the limit of the search area.
FixOptions parse_fix_options(const Fields& fields, const Limits& limits);
/// From where the search begins; nullopt where none is asked for.
std::optional<std::chrono::milliseconds> parse_time_limit(const Fields& fields);

/// "poses": objects with lat, lon, heading_deg. Throws InvalidField with the place ("poses[3].lat") or LimitExceeded
/// ("too-many-poses").
std::vector<GeoPose> parse_poses(const Fields& fields, const Limits& limits);

}  // namespace roadfix::api
