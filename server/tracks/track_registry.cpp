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

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

/// A track in memory. `turn` is told whenever a step is done.
struct TrackRegistry::Live {
  Live(std::shared_ptr<const ServedMap> map, TrackSettings settings)
      : served(std::move(map)), tracker(served->view, std::move(settings)) {}

  const std::shared_ptr<const ServedMap> served;
  const Tracker tracker;
  std::mutex mutex;
  std::condition_variable turn;
  std::multiset<std::int64_t> waiting;  ///< sequence numbers of the steps that are here
  TrackerState state;
  bool ended = false;
};

TrackRegistry::TrackRegistry(const std::filesystem::path& store, TrackLimits limits, const MapRegistry& maps,
                             const api::Limits& request_limits)
    : limits_(limits), maps_(maps), request_limits_(request_limits) {
  try {
    store_ = std::make_unique<TrackStore>(store);
  } catch (const Error&) {
    failure_ = std::current_exception();  // maps are served without tracks; whoever wants one is told why
  }
}

TrackStore& TrackRegistry::store() const {
  if (failure_) std::rethrow_exception(failure_);
  return *store_;
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
  auto fresh = std::make_shared<Live>(map, asked.settings);
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
  if (!track->ended.empty()) {
    throw NotFound("track-ended", fmt::format("the track '{}' has {}: POST /v1/tracks begins a new one", id,
                                              track->ended == "expired" ? "expired without a step" : "been finished"));
  }
  return *track;
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
  auto result = std::make_shared<Live>(map, parsed(track.request, request_limits_).settings);
  const StoredState stored = store().state(track.id);
  if (!stored.counters.empty()) {
    result->state = api::state_of(api::parse_json(stored.counters, {}), filter_state_of(stored.particles));
  }
  return result;
}

std::shared_ptr<TrackRegistry::Live> TrackRegistry::live(const std::string& id) {
  const StoredTrack track = find(id);
  const auto require_same_map = [&] {
    if (maps_.find(track.map)->view.version == track.map_version) return;
    throw InvalidInput("map-replaced", fmt::format("the map {} was replaced since the track began: begin a new track "
                                                   "from the last pose",
                                                   track.map));
  };
  require_same_map();
  const std::lock_guard lock(mutex_);
  auto& entry = live_[id];
  try {
    if (!entry) entry = loaded(track);
  } catch (...) {
    live_.erase(id);
    throw;
  }
  return entry;
}

void TrackRegistry::end(const std::string& id, const char* how) {
  std::shared_ptr<Live> track;
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = live_.find(id); found != live_.end()) track = found->second;
    live_.erase(id);
  }
  if (track) {
    const std::lock_guard lock(track->mutex);
    track->ended = true;
    store().end(id, how);
  } else {
    store().end(id, how);
  }
  const std::lock_guard lock(mutex_);
  ++changes_;
  news_.notify_all();
}

void TrackRegistry::finish(const std::string& id) { end(find(id).id, "finished"); }

void TrackRegistry::expire() {
  const std::int64_t before = now_us() - std::chrono::microseconds(limits_.idle).count();
  for (const StoredTrack& track : store().flying()) {
    if (track.touched_us < before) end(track.id, "expired");
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
  StepResult result = track->tracker.advance(track->state, input, limits);
  json answer = api::to_json(result.estimate);
  answer["track"] = id;
  const std::string text = text_of(answer);
  store().add_step(id, now_us(), {text_of(api::counters_json(result.state)), to_bytes(result.state.filter)},
                   {input.sequence, digest, text});
  track->state = std::move(result.state);
  const std::lock_guard registry_lock(mutex_);
  ++changes_;
  news_.notify_all();
  return text;
}

std::shared_ptr<TrackRegistry::Stream> TrackRegistry::stream(const std::string& id, std::int64_t after) {
  find(id);
  const std::lock_guard lock(mutex_);
  if (streams_ >= limits_.streams) {
    throw http::Busy(fmt::format("{} streams of events are open, as many as may", streams_), std::chrono::seconds(5));
  }
  return std::make_shared<Stream>(*this, id, after);
}

TrackRegistry::Stream::Stream(TrackRegistry& registry, std::string id, std::int64_t after)
    : registry_(registry), id_(std::move(id)), after_(after) {
  ++registry_.streams_;
}

TrackRegistry::Stream::~Stream() {
  const std::lock_guard lock(registry_.mutex_);
  --registry_.streams_;
}

std::optional<std::vector<StoredStep>> TrackRegistry::Stream::next() {
  constexpr int kBatch = 64;
  constexpr std::chrono::seconds kPatience{1};
  std::unique_lock lock(registry_.mutex_);
  const std::uint64_t seen = registry_.changes_;
  lock.unlock();
  std::vector<StoredStep> steps = registry_.store().steps_after(id_, after_, kBatch);
  if (steps.empty()) {
    const auto track = registry_.store().find(id_);
    if (!track || !track->ended.empty()) return std::nullopt;
    lock.lock();
    registry_.news_.wait_for(lock, kPatience, [&] { return registry_.stopping_ || registry_.changes_ != seen; });
    if (registry_.stopping_) return std::nullopt;
    return steps;
  }
  after_ = steps.back().sequence;
  return steps;
}

}  // namespace roadfix::server
