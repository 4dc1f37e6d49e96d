// The tracks that fly, from their beginning to their end: each with its state in the store and, once it takes steps,
// with its tracker in memory.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/locate/calibration.hpp"
#include "core/track/tracker.hpp"
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

class TrackRegistry {
 public:
  /// A store that cannot be opened is reported by problem(), and by every call below until it can. `calibration` is of
  /// the searches of all tracks, and never nullptr.
  TrackRegistry(std::filesystem::path store, TrackLimits limits, const MapRegistry& maps,
                const api::Limits& request_limits,
                std::shared_ptr<const Calibration> calibration = shipped_calibration());

  const TrackLimits& limits() const { return limits_; }
  /// Why tracks cannot be kept now, as far as the last step told.
  std::optional<std::string> problem() const;
  /// Tracks that fly, of all clients; nullopt where the store cannot say.
  std::optional<std::size_t> flying() const;
  int streams() const { return events_.streams(); }
  /// Ends the streams of events.
  void stop() { events_.stop(); }

  /// Ends the tracks that have expired, and lets go of maps that are no longer served. To be called now and then: to
  /// the clients an expired track has ended anyway.
  void tidy();

  /// `request` is the JSON object of the client. Throws what parse_track and Tracker throw, NotFound ("map-not-found")
  /// and LimitExceeded ("too-many-tracks").
  StoredTrack create(const std::string& client, const std::string& request);
  /// Of one client, newest first.
  std::vector<StoredTrack> of_client(const std::string& client) const;
  /// Throws NotFound ("track-not-found", "track-ended").
  StoredTrack find(const std::string& id) const;
  /// As find(), and one that has expired for as long as steps of it are kept.
  StoredTrack recorded(const std::string& id) const;
  const TrackTimes& times() const { return times_; }
  std::optional<StoredStep> step(const std::string& id, std::int64_t sequence) const;
  std::optional<StoredStep> last_step(const std::string& id) const;
  /// Throws as recorded().
  std::vector<StoredStep> steps_after(const std::string& id, std::int64_t sequence, int count) const;
  /// And deletes its steps, also those of a track that has expired. Throws as recorded().
  void finish(const std::string& id);

  /// The track with its tracker. Throws as find(), and InvalidInput ("map-replaced").
  std::shared_ptr<LiveTrack> live(const std::string& id);
  /// nullptr where it is not: no step has come since the start of the service.
  std::shared_ptr<LiveTrack> in_memory(const std::string& id) const;

  /// After the last step that was stored.
  TrackerState stored_state(const std::string& id) const;
  /// From then on neither the step nor the state after it is lost. Throws NotFound ("track-ended").
  void store_step(const std::string& id, const StoredStep& step, const TrackerState& state);
  /// Of a step that is in the store; `came` is when it did.
  void announce_step(const std::string& id, std::int64_t sequence, TrackTimes::Clock::time_point came);

  /// Throws as TrackEvents::stream and find().
  std::shared_ptr<TrackEvents::Subscription> stream(const std::string& id, std::int64_t after);

 private:
  TrackStore& store() const;
  TrackSettings calibrated(TrackSettings settings) const;
  std::optional<TrackEnd> ended(const StoredTrack& track) const;
  TrackEvents::News news(const std::string& id, std::int64_t after, int count) const;
  /// Holding `mutex_`.
  void end(const std::string& id, TrackEnd how);
  void expire();
  void let_go_of_maps();

  const std::filesystem::path path_;
  const TrackLimits limits_;
  const MapRegistry& maps_;
  const api::Limits& request_limits_;
  const std::shared_ptr<const Calibration> calibration_;
  mutable std::mutex store_mutex_;  ///< of opening it
  mutable std::unique_ptr<TrackStore> store_;
  /// Held while a track begins or ends, so that none that has ended comes back into what follows; never while a step is
  /// taken. Those of times_, events_ and the store are taken after it.
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<LiveTrack>> live_;
  TrackTimes times_;
  TrackEvents events_;
};

}  // namespace roadfix::server
