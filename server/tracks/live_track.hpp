// A track in memory: its tracker, and its state after the last step that is on disk.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "core/track/tracker.hpp"
#include "server/maps/map_registry.hpp"

namespace roadfix::server {

class LiveTrack {
 public:
  LiveTrack(std::shared_ptr<const ServedMap> map, const TrackSettings& settings, TrackerState state = {});

  const ServedMap& map() const { return *map_; }
  const Tracker& tracker() const { return tracker_; }
  /// After the last step. Waits for no step that is under way.
  std::shared_ptr<const TrackerState> last_state() const;
  /// Tracker::agl_m() after the last step. Waits for no step that is under way.
  double agl_m(double above_sea_m) const;
  /// After the last step, thinned to at most `count`; none before the first one. Waits for no step that is under way.
  std::vector<GeoPose> particles(std::size_t count) const;

  /// Waits until the step is the next one, for so long at most, and for one that is under way to its end.
  void await_predecessor(std::int64_t sequence, std::chrono::milliseconds patience);

  class Turn;

 private:
  /// Holding `mutex_`: no step is missing before this one.
  bool is_next(std::int64_t sequence) const;

  const std::shared_ptr<const ServedMap> map_;
  const Tracker tracker_;
  std::mutex mutex_;  ///< held for as long as a step takes
  std::condition_variable turn_ended_;
  std::multiset<std::int64_t> waiting_;  ///< sequence numbers of the steps that are here
  bool doubtful_ = false;
  mutable std::mutex state_mutex_;
  std::shared_ptr<const TrackerState> state_;  ///< changed by the step whose turn it is
};

/// Steps of a track take turns, the lowest sequence number first.
class LiveTrack::Turn {
 public:
  /// Waits until it is this step's turn, and for so long at most for one before it that was overtaken on its way here.
  Turn(LiveTrack& track, std::int64_t sequence, std::chrono::milliseconds patience);
  ~Turn();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  const TrackerState& state() const { return *track_.state_; }
  /// Whether the store alone knows if the last step was taken.
  bool is_doubtful() const { return track_.doubtful_; }
  /// Until settle(), should the store fail.
  void doubt() { track_.doubtful_ = true; }
  void settle(TrackerState state);

 private:
  LiveTrack& track_;
  std::unique_lock<std::mutex> lock_;
  std::multiset<std::int64_t>::iterator place_;
};

}  // namespace roadfix::server
