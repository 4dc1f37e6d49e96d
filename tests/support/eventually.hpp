// Waits for what another thread or process does.
#pragma once

#include <chrono>
#include <thread>

namespace roadfix::testing {

/// Whether it came true within a minute: machines that are busy, and sanitizers, take their time.
bool eventually(const auto& condition) {
  const auto late = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > late) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace roadfix::testing
