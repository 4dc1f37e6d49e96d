// Division of whole numbers that rounds down.
#pragma once

#include <cassert>

namespace roadfix {

/// The largest whole number that is at most a / b, for b > 0. `/` rounds towards 0.
constexpr int floor_div(int a, int b) {
  assert(b > 0);
  return a / b - (a % b < 0 ? 1 : 0);
}

}  // namespace roadfix
