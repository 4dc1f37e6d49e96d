// The steps of a track at which a place was claimed.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/geodesy/latlon.hpp"

namespace roadfix::api {

struct Claim {
  std::int64_t sequence = 0;
  std::int64_t time_us = 0;
  LatLon at;
  double heading_deg = 0.0;
  std::array<double, 2> sigma_m{};
};

/// Of steps in a row.
using ClaimedStretch = std::vector<Claim>;

/// Goes on with the last stretch, or ends it where the answer to the next step claims no place: another one begins
/// then. There is one at least, and the last one may be empty.
void continue_with(std::vector<ClaimedStretch>& stretches, const nlohmann::json& answer);

/// "2023-11-14T22:13:20.123Z"; empty of a vehicle that does not know the date, whose times lie before 2000.
std::string date_of(std::int64_t time_us);

}  // namespace roadfix::api
