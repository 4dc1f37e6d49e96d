#include "server/tracks/track_registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <set>

#include "core/filter/particle_bytes.hpp"
#include "core/units/error.hpp"
#include "server/api/fields.hpp"
#include "server/api/json_body.hpp"
#include "server/api/track_json.hpp"
#include "server/api/track_request.hpp"
#include "server/http/errors.hpp"

namespace roadfix::server {
namespace {

using nlohmann::json;

std::int64_t now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

/// Nobody guesses it: who knows the id may fly the track.
std::string new_id() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", random(), random(), random(), random());
}

api::TrackRequest parsed(const std::string& request, const api::Limits& limits) {
  api::Fields fields;
  fields.add(api::parse_json(request, {}), api::track_members());
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

NotFound track_ended(const std::string& id, const std::string& how) {
  return {"track-ended", fmt::format("the track '{}' has {}: POST /v1/tracks begins a new one", id,
                                     how == "expired" ? "expired without a step" : "been finished")};
}

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

/// A track in memory. `turn` is told whenever a step is done.
struct TrackRegistry::Live {
  Live(std::shared_ptr<const ServedMap> map, const TrackSettings& settings)
      : served(std::move(map)), tracker(served->view, settings) {}

  const std::shared_ptr<const ServedMap> served;
  const Tracker tracker;
  std::mutex mutex;
  std::condition_variable turn;
  std::multiset<std::int64_t> waiting;  ///< sequence numbers of the steps that are here
  TrackerState state;
  bool doubtful = false;  ///< the store failed: it alone knows whether the last step was taken
};

TrackRegistry::TrackRegistry(std::filesystem::path store, TrackLimits limits, const MapRegistry& maps,
                             const api::Limits& request_limits, std::shared_ptr<const Calibration> calibration)
    : path_(std::move(store)),
      limits_(limits),
      maps_(maps),
      request_limits_(request_limits),
      calibration_(std::move(calibration)) {}

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
    store();
  } catch (const Error& error) {
    return error.what();
  }
  return std::nullopt;
}

void TrackRegistry::stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  news_.notify_all();
}

StoredTrack TrackRegistry::create(const std::string& client, const std::string& request) {
  expire();
  const api::TrackRequest asked = parsed(request, request_limits_);
  const auto map = maps_.find(asked.map);
  auto fresh = std::make_shared<Live>(map, calibrated(asked.settings));
  const std::lock_guard lock(mutex_);
  const std::vector<StoredTrack> flying = store().flying();
  const auto own = std::ranges::count(flying, client, &StoredTrack::client);
  if (static_cast<int>(flying.size()) >= limits_.tracks || own >= limits_.tracks_per_client) {
    throw LimitExceeded("too-many-tracks",
                        fmt::format("{} tracks fly, {} of them from this client; at most {} and {} may: end one with "
                                    "DELETE",
                                    flying.size(), own, limits_.tracks, limits_.tracks_per_client));
  }
  const std::int64_t now = now_us();
  StoredTrack track{new_id(), client, request, asked.map, map->view.version, now, now, ""};
  store().add(track);
  live_[track.id] = std::move(fresh);
  heard_[track.id] = Clock::now();
  return track;
}

std::vector<StoredTrack> TrackRegistry::of_client(const std::string& client) {
  expire();
  std::vector<StoredTrack> tracks = store().flying();
  std::erase_if(tracks, [&](const StoredTrack& track) { return track.client != client; });
  return tracks;
}

StoredTrack TrackRegistry::find(const std::string& id) const {
  const auto track = store().find(id);
  if (!track) throw NotFound("track-not-found", fmt::format("there is no track '{}': POST /v1/tracks begins one", id));
  if (const std::string how = ended(*track); !how.empty()) throw track_ended(id, how);
  return *track;
}

std::chrono::milliseconds TrackRegistry::silent(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto heard = heard_.find(id);
  return std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() -
                                                               (heard == heard_.end() ? began_ : heard->second));
}

std::string TrackRegistry::ended(const StoredTrack& track) const {
  if (!track.ended.empty()) return track.ended;
  return silent(track.id) > limits_.idle ? "expired" : "";
}

std::optional<StoredStep> TrackRegistry::last_step(const std::string& id) const {
  return store().last_step(find(id).id);
}

std::vector<StoredStep> TrackRegistry::steps_after(const std::string& id, std::int64_t sequence, int count) const {
  return store().steps_after(find(id).id, sequence, count);
}

std::vector<GeoPose> TrackRegistry::particles(const std::string& id, std::size_t count) {
  const auto track = live(id);
  const std::lock_guard lock(track->mutex);
  return track->state.started ? track->tracker.particles(track->state, count) : std::vector<GeoPose>();
}

std::shared_ptr<TrackRegistry::Live> TrackRegistry::loaded(const StoredTrack& track) const {
  const auto map = maps_.find(track.map);
  auto result = std::make_shared<Live>(map, calibrated(stored_settings(track, request_limits_)));
  result->state = stored_state(track.id);
  return result;
}

TrackerState TrackRegistry::stored_state(const std::string& id) const {
  const StoredState stored = store().state(id);
  if (stored.counters.empty()) return {};
  TrackerState state = api::state_of(api::stored_json(stored.counters), filter_state_of(stored.particles));
  state.recent = RecentFrames::of_bytes(stored.frames);
  return state;
}

std::shared_ptr<TrackRegistry::Live> TrackRegistry::live(const std::string& id) {
  const StoredTrack track = find(id);
  const bool same_map = maps_.find(track.map)->view.version == track.map_version;
  const std::lock_guard lock(mutex_);
  if (!same_map) {
    live_.erase(id);  // and lets go of the old map
    throw InvalidInput("map-replaced", fmt::format("the map {} was replaced since the track began: begin a new track "
                                                   "from the last pose",
                                                   track.map));
  }
  const auto known = live_.find(id);
  if (known != live_.end()) return known->second;
  return live_.emplace(id, loaded(track)).first->second;
}

void TrackRegistry::end(const std::string& id, const std::string& how) {
  const std::lock_guard lock(mutex_);
  store().end(id, how);
  live_.erase(id);
  heard_.erase(id);
  ++changes_;
  news_.notify_all();
}

void TrackRegistry::finish(const std::string& id) { end(find(id).id, "finished"); }

void TrackRegistry::expire() {
  for (const StoredTrack& track : store().flying()) {
    if (const std::string how = ended(track); !how.empty()) end(track.id, how);
  }
}

std::optional<std::string> TrackRegistry::answered(const std::string& id, std::int64_t sequence,
                                                   std::int64_t digest) const {
  const auto taken = store().step(find(id).id, sequence);
  if (!taken) return std::nullopt;
  if (taken->digest != digest) {
    throw InvalidInput(
        "step-differs",
        fmt::format("step {} was taken already with another content: count on from the last step", sequence));
  }
  return taken->answer;
}

std::string TrackRegistry::step(const std::string& id, const StepInput& input, std::int64_t digest,
                                const StepLimits& limits) {
  const std::shared_ptr<Live> track = live(id);
  std::unique_lock lock(track->mutex);
  const auto place = track->waiting.insert(input.sequence);
  const std::shared_ptr<void> leave(nullptr, [&](void*) {
    track->waiting.erase(place);
    track->turn.notify_all();
  });
  const auto is_first = [&] { return track->waiting.begin() == place; };
  const auto follows = [&] { return !track->state.started || input.sequence <= track->state.sequence + 1; };
  track->turn.wait_for(lock, limits_.order_wait, [&] { return is_first() && follows(); });
  track->turn.wait(lock, is_first);
  if (const auto answer = answered(id, input.sequence, digest)) return *answer;
  if (track->doubtful) track->state = stored_state(id);
  track->doubtful = false;
  StepResult result = track->tracker.advance(track->state, input, limits);
  json answer = api::to_json(result.estimate);
  answer["track"] = id;
  std::string text = text_of(answer);
  track->doubtful = true;
  const StoredState state{text_of(api::counters_json(result.state)), to_bytes(result.state.filter),
                          result.state.recent.to_bytes()};
  if (!store().add_step(id, now_us(), state, {input.sequence, digest, text})) {
    throw track_ended(id, "finished");
  }
  track->doubtful = false;
  track->state = std::move(result.state);
  const std::lock_guard registry_lock(mutex_);
  heard_[id] = Clock::now();
  ++changes_;
  news_.notify_all();
  return text;
}

std::shared_ptr<TrackRegistry::Listener> TrackRegistry::stream(const std::string& id, std::int64_t after) {
  find(id);
  const std::lock_guard lock(mutex_);
  if (streams_ >= limits_.streams) {
    throw http::Busy(fmt::format("{} streams of events are open, as many as may", streams_), std::chrono::seconds(5));
  }
  return std::make_shared<Listener>(*this, id, after);
}

TrackRegistry::Listener::Listener(TrackRegistry& registry, std::string id, std::int64_t after)
    : registry_(registry), id_(std::move(id)), after_(after) {
  ++registry_.streams_;
}

TrackRegistry::Listener::~Listener() {
  const std::lock_guard lock(registry_.mutex_);
  --registry_.streams_;
}

std::optional<TrackRegistry::Listener::News> TrackRegistry::Listener::next() {
  constexpr int kBatch = 64;
  constexpr std::chrono::seconds kPatience{1};
  std::unique_lock lock(registry_.mutex_);
  const std::uint64_t seen = registry_.changes_;
  lock.unlock();
  News news{registry_.store().steps_after(id_, after_, kBatch), {}};
  if (!news.steps.empty()) {
    after_ = news.steps.back().sequence;
    return news;
  }
  const auto track = registry_.store().find(id_);
  news.ended = track ? registry_.ended(*track) : "finished";
  if (!news.ended.empty()) return news;
  lock.lock();
  registry_.news_.wait_for(lock, kPatience, [&] { return registry_.stopping_ || registry_.changes_ != seen; });
  if (registry_.stopping_) return std::nullopt;
  return news;
}

}  // namespace roadfix::server
