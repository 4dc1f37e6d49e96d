#include "server/tracks/track_times.hpp"

#include <algorithm>

namespace roadfix::server {

std::int64_t now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

void TrackTimes::begin(const std::string& id) {
  const std::lock_guard lock(mutex_);
  heard_[id] = {Clock::now()};
}

void TrackTimes::took_step(const std::string& id, std::int64_t sequence, Clock::time_point came) {
  const std::lock_guard lock(mutex_);
  Heard& heard = heard_[id];
  heard.taken = Clock::now();
  heard.steps.push_back({sequence, came});
  if (heard.steps.size() > kAged) heard.steps.pop_front();
}

void TrackTimes::forget(const std::string& id) {
  const std::lock_guard lock(mutex_);
  heard_.erase(id);
}

std::chrono::milliseconds TrackTimes::idle(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto heard = heard_.find(id);
  const auto since = heard == heard_.end() ? began_ : heard->second.taken;
  return std::chrono::floor<std::chrono::milliseconds>(Clock::now() - since);
}

std::chrono::milliseconds TrackTimes::silent(const StoredTrack& track) const {
  const std::chrono::microseconds by_date(now_us() - track.touched_us);
  const auto idle = this->idle(track.id);
  const std::lock_guard lock(mutex_);
  return heard_.contains(track.id) ? idle : std::max(idle, std::chrono::floor<std::chrono::milliseconds>(by_date));
}

std::optional<std::chrono::microseconds> TrackTimes::age_of_step(const std::string& id, std::int64_t sequence) const {
  const std::lock_guard lock(mutex_);
  const auto heard = heard_.find(id);
  if (heard == heard_.end()) return std::nullopt;
  const auto step = std::ranges::find(heard->second.steps, sequence, &Arrival::sequence);
  if (step == heard->second.steps.end()) return std::nullopt;
  return std::chrono::floor<std::chrono::microseconds>(Clock::now() - step->came);
}

}  // namespace roadfix::server
