// When a search has to give up: at a time, or when it is asked to.
#pragma once

#include <chrono>
#include <optional>
#include <stop_token>
#include <utility>

namespace roadfix {

/// Throws Interrupted ("search-stopped") once a stop is requested.
void require_not_stopped(const std::stop_token& stop);

class Deadline {
 public:
  Deadline() = default;  ///< never
  /// `end`: nullopt = no limit.
  explicit Deadline(std::stop_token stop, std::optional<std::chrono::steady_clock::time_point> end = {})
      : stop_(std::move(stop)), end_(end) {}

  /// Whether the time is over. Throws as require_not_stopped().
  bool over() const;
  /// Whether the time is over or a stop was requested.
  bool ended() const { return stop_.stop_requested() || time_is_over(); }
  /// A deadline after this share, in [0, 1], of the time that is left.
  Deadline after(double share) const;
  /// The same, or so long from now where that is sooner; nullopt = the same.
  Deadline within(std::optional<std::chrono::milliseconds> time) const;

  const std::stop_token& stop() const { return stop_; }

 private:
  bool time_is_over() const { return end_ && std::chrono::steady_clock::now() >= *end_; }

  std::stop_token stop_;
  std::optional<std::chrono::steady_clock::time_point> end_;
};

}  // namespace roadfix
