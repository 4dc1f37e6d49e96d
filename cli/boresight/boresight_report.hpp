// What a boresight says, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/boresight/boresight_flight.hpp"
#include "core/detect/attitude.hpp"
#include "core/detect/boresight.hpp"

namespace roadfix::cli {

struct BoresightReport {
  MapId map;
  std::string csv;
  Flight flight;
  Boresight found;
  Attitude mounted;  ///< what counted already when the flight was recorded
};

/// With what to tell scripts/mavlink_steps, and what was not known well or told wrongly.
std::string boresight_text(const BoresightReport& report);
nlohmann::json boresight_json(const BoresightReport& report);

}  // namespace roadfix::cli
