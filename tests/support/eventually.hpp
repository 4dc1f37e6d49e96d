// Waits for what another thread or process does.
#pragma once

#include <chrono>
#include <thread>

namespace roadfix::testing {

/// Whether it came true within ten seconds.
bool eventually(const auto& condition) {
  for (int i = 0; i < 400; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  }
  return false;
}

}  // namespace roadfix::testing
