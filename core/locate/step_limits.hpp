// What one step of a track may take.
#pragma once

#include <chrono>
#include <optional>
#include <stop_token>

namespace roadfix {

struct StepLimits {
  int threads = 1;
  std::optional<std::chrono::steady_clock::time_point> searches_end{};  ///< at it a search ends as it is
  std::stop_token stop;
};

}  // namespace roadfix
