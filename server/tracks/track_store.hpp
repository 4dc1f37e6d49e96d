// The tracks on disk: a SQLite file in WAL mode, synchronised at every step, so that nothing that was answered is lost
// when the process or the machine dies. One process at a time has it open.
//
// All functions may be called from several threads and throw IoFailure ("track-store-full", "track-store-read-only",
// "track-store-unavailable"), CorruptData ("track-store-corrupt") or InUse ("track-store-busy").
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/locate/map_id.hpp"
#include "core/units/file.hpp"

namespace roadfix::server {

enum class TrackEnd { kFinished, kExpired };

/// "finished" or "expired".
const char* to_string(TrackEnd end);

struct StoredTrack {
  std::string id;
  std::string client;
  std::string request;  ///< JSON
  MapId map;
  std::int64_t created_us = 0;
  std::int64_t touched_us = 0;
  std::optional<TrackEnd> ended;  ///< nullopt while it flies
};

struct StoredStep {
  std::int64_t sequence = 0;
  std::int64_t digest = 0;
  std::string answer;
};

class TrackFile;

class TrackStore {
 public:
  /// Creates the file where there is none. Beyond `max_bytes`, or what its disk has free, it is full: flights that are
  /// over, of which steps are kept, give way then.
  TrackStore(const std::filesystem::path& path, std::int64_t max_bytes, FreeBytes free_bytes = free_bytes_beside);
  ~TrackStore();
  TrackStore(const TrackStore&) = delete;
  TrackStore& operator=(const TrackStore&) = delete;

  /// What failed since a step was last stored or a track ended, or that the file was deleted since it was opened;
  /// nullopt where nothing did.
  std::optional<std::string> problem() const;

  /// As one that flies.
  void add(const StoredTrack& track);
  std::optional<StoredTrack> find(const std::string& id) const;
  /// After the last step (core/track/tracker_bytes); empty before the first one.
  std::vector<std::byte> state(const std::string& id) const;
  /// Newest first.
  std::vector<StoredTrack> flying() const;

  /// The step and the state after it, at once. False where the track has ended; nothing is written then.
  [[nodiscard]] bool add_step(const std::string& id, std::int64_t now_us, std::span<const std::byte> state,
                              const StoredStep& step);
  std::optional<StoredStep> step(const std::string& id, std::int64_t sequence) const;
  /// The last one, if there was any.
  std::optional<StoredStep> last_step(const std::string& id) const;
  /// Up to `count` steps above the sequence number, in order.
  std::vector<StoredStep> steps_after(const std::string& id, std::int64_t sequence, int count) const;

  /// Takes the state away, and of a track that is finished the steps; keeps that there was such a track and how it
  /// ended first for as long as it is among the last 100 that ended like this. The steps of one that expired stay as
  /// long, unless the file is half full and they are of the first that ended. Dates count for nothing. Returns the
  /// steps above the sequence number, in order: the last 10,000 of them at most, none without one.
  std::vector<StoredStep> end(const std::string& id, TrackEnd how, std::optional<std::int64_t> sequence = {});

 private:
  std::unique_ptr<TrackFile> file_;
};

}  // namespace roadfix::server
