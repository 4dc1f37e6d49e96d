#include "server/tracks/live_track.hpp"

#include <utility>

namespace roadfix::server {

LiveTrack::LiveTrack(std::shared_ptr<const ServedMap> map, const TrackSettings& settings, TrackerState state)
    : map_(std::move(map)),
      tracker_(map_->view, settings),
      state_(std::make_shared<const TrackerState>(std::move(state))) {}

std::shared_ptr<const TrackerState> LiveTrack::last_state() const {
  const std::lock_guard lock(state_mutex_);
  return state_;
}

double LiveTrack::agl_m(double above_sea_m) const { return tracker_.agl_m(*last_state(), above_sea_m); }

std::vector<GeoPose> LiveTrack::particles(std::size_t count) const {
  const std::shared_ptr<const TrackerState> state = last_state();
  return state->last ? tracker_.particles(*state, count) : std::vector<GeoPose>();
}

bool LiveTrack::is_next(std::int64_t sequence) const { return !state_->last || sequence <= state_->last->sequence + 1; }

void LiveTrack::await_predecessor(std::int64_t sequence, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  turn_ended_.wait_for(lock, patience, [&] { return is_next(sequence); });
}

LiveTrack::Turn::Turn(LiveTrack& track, std::int64_t sequence, std::chrono::milliseconds patience)
    : track_(track), lock_(track.mutex_), place_(track.waiting_.insert(sequence)) {
  const auto is_first = [&] { return track_.waiting_.begin() == place_; };
  track_.turn_ended_.wait_for(lock_, patience, [&] { return is_first() && track_.is_next(sequence); });
  track_.turn_ended_.wait(lock_, is_first);
}

LiveTrack::Turn::~Turn() {
  track_.waiting_.erase(place_);
  track_.turn_ended_.notify_all();
}

void LiveTrack::Turn::settle(TrackerState state) {
  auto settled = std::make_shared<const TrackerState>(std::move(state));
  track_.doubtful_ = false;
  const std::lock_guard lock(track_.state_mutex_);
  track_.state_.swap(settled);
}

}  // namespace roadfix::server
