// Splitting a search over threads, and ending it in time.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>

namespace roadfix {

/// Says when a search has to give up.
class Deadline {
 public:
  Deadline(std::stop_token stop, std::optional<std::chrono::steady_clock::time_point> end)
      : stop_(std::move(stop)), end_(end) {}
  /// Whether the time is over; throws Interrupted if a stop was requested.
  bool over() const;
  /// Throws Interrupted once the time is over or a stop was requested.
  void check() const;
  /// A deadline after this share of the time that is left.
  Deadline after(double share) const;

 private:
  std::stop_token stop_;
  std::optional<std::chrono::steady_clock::time_point> end_;
};

/// Calls work(i) for 0 <= i < count from up to `threads` threads; the first exception ends it and is thrown here.
void parallel_for(int count, int threads, const std::function<void(int)>& work);

}  // namespace roadfix
