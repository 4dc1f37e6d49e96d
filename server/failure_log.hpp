// What of the requests that failed belongs into the service's own log.
#pragma once

#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace roadfix::server {

/// Faults of the service (500) are told each time. What stands in its way from outside (503: a disk that is full, a map
/// that is damaged, a file that another holds, no memory) is told at most once in 10 s for each code, since every
/// client meets it. That more is asked than it can do is not told: the metrics count it.
class FailureLog {
 public:
  using Clock = std::chrono::steady_clock;

  /// The line to log, nullopt for none. Safe from several threads.
  std::optional<std::string> line(const std::exception_ptr& thrown, int status, const std::string& request_id,
                                  Clock::time_point now = Clock::now());

 private:
  struct Recent {
    Clock::time_point told;
    int untold = 0;
  };
  std::optional<std::string> throttled(const std::string& code, const std::string& text, Clock::time_point now);

  std::mutex mutex_;
  std::map<std::string, Recent> recent_;  ///< by code or text, of which there are few
};

}  // namespace roadfix::server
