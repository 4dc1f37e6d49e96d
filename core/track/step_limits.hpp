// What one step of a track may take.
#pragma once

#include "core/match/deadline.hpp"

namespace roadfix {

struct StepLimits {
  int threads = 1;
  Deadline deadline{};  ///< at it a search ends as it is
};

}  // namespace roadfix
