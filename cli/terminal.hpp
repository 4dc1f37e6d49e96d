// Talking to a person or a script: progress on stderr (redrawn on a terminal, a line now and then otherwise),
// and Ctrl-C as a stop token.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <string>

#include "core/units/progress.hpp"

namespace roadfix::cli {

/// Called first in main: a signal goes to any thread that does not block it, and those that libraries start block what
/// the one does that starts them. SIGINT, SIGTERM and SIGHUP still end the process; a file that may not grow any more
/// (ulimit -f, LimitFSIZE=) does not, but fails to be written to.
void watch_signals();

/// Requested by the first SIGINT, SIGTERM or, unless it is ignored (nohup), SIGHUP from now on; a second one ends the
/// process at once. After watch_signals().
std::stop_token stop_on_signals();

/// Share done, rate and time left of one long task.
class Progress {
 public:
  /// `unit` and `units_per_item` give the rate: 65536 px an item and "MP" with 0.065536 print MP/s.
  Progress(std::string task, std::string unit, double units_per_item = 1.0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Safe from several threads. The rate counts only what was done since the first call (resumed work is not speed).
  void update(std::int64_t done, std::int64_t total);
  /// update() for work that reports how far it is. The progress must outlive it.
  OnProgress updates();
  /// As updates(), but says nothing of work that is over two seconds from now.
  OnProgress updates_if_long();

 private:
  void print(std::int64_t done, std::int64_t total);

  using Clock = std::chrono::steady_clock;
  std::mutex mutex_;
  std::string task_;
  std::string unit_;
  double units_per_item_;
  bool terminal_;
  Clock::time_point started_;
  Clock::time_point last_print_;
  std::int64_t first_done_ = -1;
  bool line_open_ = false;
};

}  // namespace roadfix::cli
