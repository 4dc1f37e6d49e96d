// What a service is told of a flight.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/fly/flight.hpp"
#include "cli/fly/service_plan.hpp"
#include "core/locate/prior.hpp"

namespace roadfix::fly {

/// The body of POST /v1/tracks.
nlohmann::json track_request(const ServicePlan& plan, std::uint64_t seed, const Prior& start);

/// JSON where nothing was seen, else a picture, described in the query.
struct StepRequest {
  std::string query;  ///< with its "?", or empty
  std::string body;
  const char* content_type = "";
};

StepRequest step_request(const Report& step);

}  // namespace roadfix::fly
