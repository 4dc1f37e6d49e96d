// The file that tracks are stored in: who holds it, what it refuses, and whether it is still there.
//
// Throws what track_store.hpp says.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "tiles/store/file_identity.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix::server {

/// The code where no more fits into the file.
inline constexpr const char* kTrackStoreFull = "track-store-full";

class TrackFile {
 public:
  /// Creates the file and its tables where there are none.
  TrackFile(const std::filesystem::path& path, std::int64_t max_bytes, FreeBytes free_bytes);
  TrackFile(const TrackFile&) = delete;
  TrackFile& operator=(const TrackFile&) = delete;

  /// Runs work on the connection, one caller at a time.
  template <typename Work>
  auto with(Work work) -> decltype(work()) {
    const std::lock_guard lock(mutex_);
    try {
      return work();
    } catch (const Error& error) {
      problem_ = error.what();
      throw;
    }
  }

  // Of work that runs:

  sqlite::Connection& connection() { return *connection_; }
  /// How far the file, as large as it may become on its disk, is filled, 0 to 1.
  double filled();
  /// Where it is to write: SQLite goes on with a file that was deleted, and what it writes there is lost at the end of
  /// the process. Throws IoFailure "track-store-unavailable".
  void require_file() const;
  /// What failed before is over. A track that begins is too small to show that.
  void has_room() { problem_.reset(); }

  /// What failed last, that the file was deleted, or that its disk was full when it was opened; else nullopt.
  std::optional<std::string> problem() const;

 private:
  std::optional<std::string> missing_file() const;

  const std::filesystem::path path_;
  const FreeBytes free_bytes_;
  mutable std::mutex mutex_;
  std::optional<sqlite::Connection> connection_;
  std::optional<FileIdentity> identity_;  ///< of the file when it was opened
  std::optional<std::string> problem_;
};

}  // namespace roadfix::server
