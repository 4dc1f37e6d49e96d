// A service that flights are told to, and how.
#pragma once

#include <chrono>
#include <stop_token>
#include <string>

#include "cli/fly/localizer.hpp"

namespace roadfix::fly {

struct ServicePlan {
  std::string base;  ///< "http://HOST:PORT"
  std::string map;   ///< its name there
  FilterPlan filter;
  /// How long a request that gets no answer, or one that may pass, is sent again and again: long enough for a service
  /// that was killed to come back.
  std::chrono::seconds patience{60};
  bool keeps_tracks = false;  ///< else they are ended after the flight
  std::stop_token stop;
};

}  // namespace roadfix::fly
