#include "core/match/work.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/units/error.hpp"

namespace roadfix {

bool Deadline::over() const {
  if (stop_.stop_requested()) throw Interrupted("search-stopped", "the search was asked to stop before it was done");
  return end_ && std::chrono::steady_clock::now() >= *end_;
}

void Deadline::check() const {
  if (over()) {
    throw Interrupted(
        "search-time-limit",
        "the search did not end within its time limit: give a smaller region, a narrower heading range or "
        "more time");
  }
}

Deadline Deadline::after(double share) const {
  if (!end_) return *this;
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> left = *end_ - now;
  return {stop_, now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(share * left)};
}

void parallel_for(int count, int threads, const std::function<void(int)>& work) {
  std::atomic<int> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      for (int i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < std::min(threads, count); ++i) helpers.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace roadfix
