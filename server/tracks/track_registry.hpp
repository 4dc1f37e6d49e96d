// The tracks that fly: each with its tracker in memory and its state in the store. Steps of one track are taken one at
// a time and in order; those of different tracks run side by side.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/locate/tracker.hpp"
#include "server/api/limits.hpp"
#include "server/maps/map_registry.hpp"
#include "server/tracks/live_track.hpp"
#include "server/tracks/track_events.hpp"
#include "server/tracks/track_store.hpp"
#include "server/tracks/track_times.hpp"

namespace roadfix::server {

struct TrackLimits {
  int tracks = 1000;
  int tracks_per_client = 64;
  int streams = 16;                           ///< of events, at the same time
  std::chrono::milliseconds idle{3'600'000};  ///< without a step, then a track has ended
  std::chrono::milliseconds order_wait{100};  ///< for a step that was overtaken on its way here
  int steps_waiting = 16;                     ///< for those before them, of all tracks
  std::int64_t store_bytes = std::int64_t{8} << 30;
};

/// What a step was answered.
struct StepAnswer {
  nlohmann::json answer;
  std::string text;       ///< the same, byte by byte as it was told before and is stored
  bool repeated = false;  ///< the step had been taken before
};

class TrackRegistry {
 public:
  /// A store that cannot be opened is reported by problem(), and by every call below until it can. `calibration` is of
  /// the searches of all tracks; nullptr = the one that is shipped.
  TrackRegistry(std::filesystem::path store, TrackLimits limits, const MapRegistry& maps,
                const api::Limits& request_limits, std::shared_ptr<const Calibration> calibration = nullptr);

  const TrackLimits& limits() const { return limits_; }
  /// Why tracks cannot be kept now, as far as the last step told.
  std::optional<std::string> problem() const;
  /// Tracks that fly, of all clients; nullopt where the store cannot say.
  std::optional<std::size_t> flying() const;
  int streams() const { return events_.streams(); }
  /// Ends the streams of events.
  void stop() { events_.stop(); }

  /// `request` is the JSON object of the client. Throws what parse_track and Tracker throw, NotFound ("map-not-found")
  /// and LimitExceeded ("too-many-tracks").
  StoredTrack create(const std::string& client, const std::string& request);
  /// Of one client, newest first.
  std::vector<StoredTrack> of_client(const std::string& client) const;
  /// Throws NotFound ("track-not-found", "track-ended").
  StoredTrack find(const std::string& id) const;
  const TrackTimes& times() const { return times_; }
  std::optional<StoredStep> last_step(const std::string& id) const;
  std::vector<StoredStep> steps_after(const std::string& id, std::int64_t sequence, int count) const;
  /// At most `count`; none before the first step. Throws InvalidInput ("map-replaced").
  std::vector<GeoPose> particles(const std::string& id, std::size_t count);
  void finish(const std::string& id);

  /// What a step was answered, if it was taken already. Throws InvalidInput ("step-differs") where that was another
  /// step of the same number.
  std::optional<StepAnswer> answered(const std::string& id, std::int64_t sequence, std::int64_t digest) const;
  /// Gives the steps that this one overtook the time that they may have to be taken first. They may need a turn among
  /// the searches for that, so that it holds none meanwhile. Throws Busy where too many wait.
  void await_predecessor(const std::string& id, std::int64_t sequence);
  /// Takes the step, unless that was done meanwhile, and returns its answer once it cannot be lost any more. Throws
  /// what Tracker::advance throws, InvalidInput ("map-replaced") and the store's errors; the track is then as it was.
  /// `came` is when the step did.
  StepAnswer step(const std::string& id, const StepInput& input, std::int64_t digest, const StepLimits& limits,
                  TrackTimes::Clock::time_point came = TrackTimes::Clock::now());

  /// Throws as TrackEvents::stream and find().
  std::shared_ptr<TrackEvents::Stream> stream(const std::string& id, std::int64_t after);

 private:
  TrackStore& store() const;
  TrackSettings calibrated(TrackSettings settings) const;
  std::shared_ptr<LiveTrack> live(const std::string& id);
  std::shared_ptr<LiveTrack> loaded(const StoredTrack& track, std::shared_ptr<const ServedMap> map) const;
  TrackerState stored_state(const std::string& id) const;
  std::optional<TrackEnd> ended(const StoredTrack& track) const;
  TrackEvents::News news(const std::string& id, std::int64_t after, int count) const;
  void end(const std::string& id, TrackEnd how);
  void expire();

  const std::filesystem::path path_;
  const TrackLimits limits_;
  const MapRegistry& maps_;
  const api::Limits& request_limits_;
  const std::shared_ptr<const Calibration> calibration_;
  mutable std::mutex store_mutex_;  ///< of opening it
  mutable std::unique_ptr<TrackStore> store_;
  mutable std::mutex mutex_;  ///< of what follows; never held while a step is taken
  std::map<std::string, std::shared_ptr<LiveTrack>> live_;
  int steps_waiting_ = 0;
  TrackTimes times_;
  TrackEvents events_;
};

}  // namespace roadfix::server
