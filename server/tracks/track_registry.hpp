// The tracks that fly: each with its tracker in memory and its state in the store. Steps of one track are taken one at
// a time and in order; those of different tracks run side by side.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/locate/tracker.hpp"
#include "server/api/limits.hpp"
#include "server/maps/map_registry.hpp"
#include "server/tracks/track_store.hpp"

namespace roadfix::server {

struct TrackLimits {
  int tracks = 1000;
  int tracks_per_client = 64;
  int streams = 16;                           ///< of events, at the same time
  std::chrono::seconds idle{3600};            ///< without a step, then a track has ended
  std::chrono::milliseconds order_wait{100};  ///< for a step that was overtaken on its way here
};

class TrackRegistry {
 public:
  /// A store that cannot be opened is reported by problem(), and by every call below.
  TrackRegistry(const std::filesystem::path& store, TrackLimits limits, const MapRegistry& maps,
                const api::Limits& request_limits);

  const TrackLimits& limits() const { return limits_; }
  std::optional<std::string> problem() const;
  /// Ends the streams of events.
  void stop();

  /// `request` is the JSON object of the client. Throws what parse_track and Tracker throw, NotFound ("map-not-found")
  /// and LimitExceeded ("too-many-tracks").
  StoredTrack create(const std::string& client, const std::string& request);
  /// Of one client, newest first.
  std::vector<StoredTrack> of_client(const std::string& client);
  /// Throws NotFound ("track-not-found", "track-ended").
  StoredTrack find(const std::string& id) const;
  std::optional<StoredStep> last_step(const std::string& id) const;
  std::vector<StoredStep> steps_after(const std::string& id, std::int64_t sequence, int count) const;
  /// At most `count`; none before the first step. Throws InvalidInput ("map-replaced").
  std::vector<GeoPose> particles(const std::string& id, std::size_t count);
  void finish(const std::string& id);

  /// What a step was answered, if it was taken already. Throws InvalidInput ("step-differs") where that was another
  /// step of the same number.
  std::optional<std::string> answered(const std::string& id, std::int64_t sequence, std::int64_t digest) const;
  /// Takes the step and returns its answer once it cannot be lost any more. Throws what Tracker::advance throws,
  /// InvalidInput ("map-replaced") and the store's errors; the track is then as it was.
  std::string step(const std::string& id, const StepInput& input, std::int64_t digest, const StepLimits& limits);

  /// One stream of events for as long as it lives. Throws Busy.
  class Stream;
  std::shared_ptr<Stream> stream(const std::string& id, std::int64_t after);

 private:
  struct Live;
  TrackStore& store() const;
  std::shared_ptr<Live> live(const std::string& id);
  std::shared_ptr<Live> loaded(const StoredTrack& track) const;
  void end(const std::string& id, const char* how);
  void expire();

  const TrackLimits limits_;
  const MapRegistry& maps_;
  const api::Limits& request_limits_;
  std::unique_ptr<TrackStore> store_;
  std::exception_ptr failure_;
  mutable std::mutex mutex_;  ///< of what follows; never held while a step is taken
  std::condition_variable news_;
  std::map<std::string, std::shared_ptr<Live>> live_;
  std::uint64_t changes_ = 0;
  int streams_ = 0;
  bool stopping_ = false;
};

class TrackRegistry::Stream {
 public:
  Stream(TrackRegistry& registry, std::string id, std::int64_t after);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Steps that were not handed out yet; waits for some, but not long. nullopt when the track has ended or the service
  /// stops.
  std::optional<std::vector<StoredStep>> next();

 private:
  TrackRegistry& registry_;
  const std::string id_;
  std::int64_t after_;
};

}  // namespace roadfix::server
