// When tracks were heard, by a clock that nobody can set, and from the start of the service at the earliest: a machine
// without GPS may learn the date in mid-flight.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "server/tracks/track_store.hpp"

namespace roadfix::server {

/// Of the date, since 1970.
std::int64_t now_us();

class TrackTimes {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kAged = 100;

  void begin(const std::string& id);
  /// `came` is when the step did.
  void took_step(const std::string& id, std::int64_t sequence, Clock::time_point came);
  void forget(const std::string& id);

  /// Since its last step, its beginning or the start of the service: a track has TrackLimits::idle from then.
  std::chrono::milliseconds idle(const std::string& id) const;
  /// Since its last step or its beginning. Of a track that was not heard since the service started the date tells how
  /// long before that: silence that the clock makes up is better than a place from before taken for one of now.
  std::chrono::milliseconds silent(const StoredTrack& track) const;
  /// How old the answer to a step is: since it came first, the time that it took included. Known of the last kAged
  /// steps that were taken since the start of the service.
  std::optional<std::chrono::microseconds> age_of_step(const std::string& id, std::int64_t sequence) const;

 private:
  struct Arrival {
    std::int64_t sequence = 0;
    Clock::time_point came;
  };
  struct Heard {
    Clock::time_point taken;  ///< the last step, or the beginning
    std::deque<Arrival> steps = {};
  };

  const Clock::time_point began_ = Clock::now();
  mutable std::mutex mutex_;
  std::map<std::string, Heard> heard_;  ///< of the tracks that were heard since the start
};

}  // namespace roadfix::server
