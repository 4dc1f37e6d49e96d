#include "server/tracks/track_registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <set>

#include "core/track/tracker_bytes.hpp"
#include "core/units/error.hpp"
#include "server/api/fields.hpp"
#include "server/api/json_body.hpp"
#include "server/api/track_request.hpp"

namespace roadfix::server {
namespace {

/// Nobody guesses it: who knows the id may fly the track.
std::string new_id() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", random(), random(), random(), random());
}

api::TrackRequest parsed(const std::string& request, const api::Limits& limits) {
  api::Fields fields;
  fields.add(api::parse_json(request), api::track_members());
  return api::parse_track(fields, limits);
}

/// One that the service took once, under the limits of today.
TrackSettings stored_settings(const StoredTrack& track, const api::Limits& limits) {
  try {
    return parsed(track.request, limits).settings;
  } catch (const InvalidInput& error) {
    throw CorruptData("track-store-corrupt",
                      fmt::format("the track '{}' is stored with a request that cannot be taken any more ({}): delete "
                                  "it and begin a new one",
                                  track.id, error.what()));
  }
}

NotFound track_ended(const std::string& id, TrackEnd how) {
  return {"track-ended", fmt::format("the track '{}' has {}: POST /v1/tracks begins a new one", id,
                                     how == TrackEnd::kExpired ? "expired without a step" : "been finished")};
}

}  // namespace

TrackRegistry::TrackRegistry(std::filesystem::path store, TrackLimits limits, const MapRegistry& maps,
                             const api::Limits& request_limits, std::shared_ptr<const Calibration> calibration)
    : path_(std::move(store)),
      limits_(limits),
      maps_(maps),
      request_limits_(request_limits),
      calibration_(std::move(calibration)),
      events_(limits.streams, [this](const auto& id, auto after, int count) { return news(id, after, count); }) {}

/// Maps are served also while this fails; whoever wants a track is told why.
TrackStore& TrackRegistry::store() const {
  const std::lock_guard lock(store_mutex_);
  if (!store_) store_ = std::make_unique<TrackStore>(path_, limits_.store_bytes);
  return *store_;
}

TrackSettings TrackRegistry::calibrated(TrackSettings settings) const {
  settings.calibration = calibration_;
  return settings;
}

std::optional<std::string> TrackRegistry::problem() const {
  try {
    return store().problem();
  } catch (const Error& error) {
    return error.what();
  }
}

StoredTrack TrackRegistry::create(const std::string& client, const std::string& request) {
  tidy();
  const api::TrackRequest asked = parsed(request, request_limits_);
  const auto map = maps_.find(asked.map);
  auto fresh = std::make_shared<LiveTrack>(map, calibrated(asked.settings));
  const std::lock_guard lock(mutex_);
  const std::vector<StoredTrack> flying = store().flying();
  const auto own = std::ranges::count(flying, client, &StoredTrack::client);
  if (static_cast<int>(flying.size()) >= limits_.tracks || own >= limits_.tracks_per_client) {
    throw LimitExceeded(
        "too-many-tracks",
        fmt::format("{} tracks are active, {} of them from this client; the limits are {} and {}: end one with DELETE",
                    flying.size(), own, limits_.tracks, limits_.tracks_per_client));
  }
  const std::int64_t now = now_us();
  StoredTrack track{new_id(), client, request, map->view.id, now, now, {}};
  times_.begin(track.id);  // before others see it in the store, or it would have been silent since the service started
  try {
    store().add(track);
  } catch (...) {
    times_.forget(track.id);
    throw;
  }
  live_[track.id] = std::move(fresh);
  return track;
}

std::optional<std::size_t> TrackRegistry::flying() const {
  try {
    const std::vector<StoredTrack> tracks = store().flying();
    return std::ranges::count_if(tracks, [&](const StoredTrack& track) { return !ended(track); });
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::vector<StoredTrack> TrackRegistry::of_client(const std::string& client) const {
  std::vector<StoredTrack> tracks = store().flying();
  std::erase_if(tracks, [&](const StoredTrack& track) { return track.client != client || ended(track); });
  return tracks;
}

StoredTrack TrackRegistry::find(const std::string& id) const {
  const auto track = store().find(id);
  if (!track) throw NotFound("track-not-found", fmt::format("there is no track '{}': POST /v1/tracks begins one", id));
  if (const auto how = ended(*track)) throw track_ended(id, *how);
  return *track;
}

StoredTrack TrackRegistry::recorded(const std::string& id) const {
  const auto track = store().find(id);
  if (track && ended(*track) == TrackEnd::kExpired && store().last_step(id)) return *track;
  return find(id);
}

std::optional<TrackEnd> TrackRegistry::ended(const StoredTrack& track) const {
  if (!track.ended && times_.idle(track.id) > limits_.idle) return TrackEnd::kExpired;
  return track.ended;
}

std::optional<StoredStep> TrackRegistry::step(const std::string& id, std::int64_t sequence) const {
  return store().step(find(id).id, sequence);
}

std::optional<StoredStep> TrackRegistry::last_step(const std::string& id) const {
  return store().last_step(find(id).id);
}

std::vector<StoredStep> TrackRegistry::steps_after(const std::string& id, std::int64_t sequence, int count) const {
  return store().steps_after(recorded(id).id, sequence, count);
}

std::shared_ptr<TrackEvents::Subscription> TrackRegistry::stream(const std::string& id, std::int64_t after) {
  return events_.stream(find(id).id, after);
}

TrackEvents::News TrackRegistry::news(const std::string& id, std::int64_t after, int count) const {
  const auto track = store().find(id);
  const std::optional<TrackEnd> how = track ? ended(*track) : TrackEnd::kFinished;
  return {store().steps_after(id, after, count), how};
}

std::shared_ptr<LiveTrack> TrackRegistry::live(const std::string& id) {
  const StoredTrack track = find(id);
  const auto map = maps_.find(track.map.name);
  const std::lock_guard lock(mutex_);
  if (map->view.id.version != track.map.version) {
    live_.erase(id);  // and lets go of the old map
    throw InvalidInput("map-replaced", fmt::format("the map {} was replaced since the track began: begin a new track "
                                                   "from the last pose",
                                                   track.map.name));
  }
  const auto known = live_.find(id);
  if (known != live_.end()) return known->second;
  // It may have ended since it was found; while `mutex_` is held, none does.
  const auto now = store().find(id);
  if (const auto how = now ? now->ended : TrackEnd::kFinished) throw track_ended(id, *how);
  auto loaded = std::make_shared<LiveTrack>(map, calibrated(stored_settings(track, request_limits_)), stored_state(id));
  return live_.emplace(id, std::move(loaded)).first->second;
}

std::shared_ptr<LiveTrack> TrackRegistry::in_memory(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto known = live_.find(id);
  return known == live_.end() ? nullptr : known->second;
}

TrackerState TrackRegistry::stored_state(const std::string& id) const {
  const std::vector<std::byte> stored = store().state(id);
  return stored.empty() ? TrackerState() : tracker_state_of(stored);
}

void TrackRegistry::store_step(const std::string& id, const StoredStep& step, const TrackerState& state) {
  if (!store().add_step(id, now_us(), to_bytes(state), step)) throw track_ended(id, TrackEnd::kFinished);
}

void TrackRegistry::announce_step(const std::string& id, std::int64_t sequence, TrackTimes::Clock::time_point came) {
  {
    const std::lock_guard lock(mutex_);
    if (live_.contains(id)) times_.took_step(id, sequence, came);  // else it has ended since
  }
  events_.announce();
}

void TrackRegistry::end(const std::string& id, TrackEnd how) {
  events_.end(id, [&](const auto& after) { return store().end(id, how, after); });
  live_.erase(id);
  times_.forget(id);
}

void TrackRegistry::finish(const std::string& id) {
  const std::lock_guard lock(mutex_);
  end(recorded(id).id, TrackEnd::kFinished);
}

void TrackRegistry::tidy() {
  let_go_of_maps();
  expire();
}

/// A track that is not in memory comes back with its next step. One that takes a step keeps its map until then.
void TrackRegistry::let_go_of_maps() {
  std::set<const ServedMap*> served;
  const auto maps = maps_.maps();
  for (const auto& map : maps) served.insert(map.get());
  std::vector<std::shared_ptr<LiveTrack>> outdated;  // outlive the lock: the last one frees all of a map
  const std::lock_guard lock(mutex_);
  std::erase_if(live_, [&](const auto& item) {
    const auto& [id, track] = item;
    if (track.use_count() > 1 || served.contains(&track->map())) return false;
    outdated.push_back(track);
    return true;
  });
}

void TrackRegistry::expire() {
  for (const StoredTrack& track : store().flying()) {
    const std::lock_guard lock(mutex_);  // a step that is taken meanwhile keeps the track
    const auto live = live_.find(track.id);
    const bool takes_a_step = live != live_.end() && live->second.use_count() > 1;
    if (const auto how = ended(track); how && !takes_a_step) end(track.id, *how);
  }
}

}  // namespace roadfix::server
