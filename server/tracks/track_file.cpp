#include "server/tracks/track_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <utility>

#include "schema/schema.hpp"

namespace roadfix::server {
namespace {

constexpr std::int64_t kPageBytes = 4096;
constexpr std::int64_t kMiB = 1 << 20;
constexpr std::int64_t kLogBytes = 4 * kMiB;  // SQLite moves a thousand pages of its log into the file
constexpr int kVersion = 5;                   // of what a state holds, too

IoFailure not_writable(const std::filesystem::path& path) {
  return {"track-store-read-only",
          fmt::format("{}: the tracks cannot be written to: start the service with --tracks FILE where it may write",
                      path.string())};
}

/// SQLite would only say that the file is not there.
void require_writable_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) == 0) return;
  if (errno == EACCES || errno == EROFS) throw not_writable(path);
}

/// SQLite does not tell a full disk from its own limit: what the disk has free does. Where it has next to nothing, not
/// even an end of a track finds room in the log.
IoFailure full(const std::filesystem::path& path, std::int64_t max_bytes, std::optional<std::int64_t> free_bytes) {
  if (free_bytes && *free_bytes < kLogBytes) {
    return {
        kTrackStoreFull,
        fmt::format("{}: no space left for the tracks: their disk has {} MiB free, and their log takes up to {} MiB: "
                    "nothing was changed; make room on the disk (to end tracks takes some, too), then send the "
                    "request again",
                    path.string(), *free_bytes / kMiB, kLogBytes / kMiB)};
  }
  const std::string disk = free_bytes ? fmt::format(", and its disk has {} MiB free", *free_bytes / kMiB) : "";
  return {
      kTrackStoreFull,
      fmt::format("{}: no space left for the tracks (serve --tracks-size allows {} MiB{}): nothing was changed; end "
                  "tracks or make room, then send the request again",
                  path.string(), max_bytes / kMiB, disk)};
}

/// What a refusal of SQLite means for this store, which may have `max_bytes` on a disk with so much room.
std::exception_ptr store_error(const std::filesystem::path& path, sqlite::Failure failure, const std::string& detail,
                               std::int64_t max_bytes, const FreeBytes& free_bytes) {
  using sqlite::Failure;
  using std::make_exception_ptr;
  const std::string file = path.string();
  switch (failure) {
    case Failure::kFull:
      return make_exception_ptr(full(path, max_bytes, free_bytes(path)));
    case Failure::kNotWritable:
    case Failure::kMoved:
      return make_exception_ptr(not_writable(path));
    case Failure::kDamaged:
    case Failure::kNotADatabase:
    case Failure::kOtherTables:
      return make_exception_ptr(CorruptData(
          "track-store-corrupt",
          fmt::format(
              "{}: the file of the tracks is damaged or no such file ({}): move it away and restart the service", file,
              detail)));
    case Failure::kBusy:
      return make_exception_ptr(InUse(
          "track-store-busy",
          fmt::format("{}: another service uses this file: stop it, or start this one with --tracks FILE", file)));
    case Failure::kNeedsRecovery:
    case Failure::kOther:
      break;
  }
  return make_exception_ptr(IoFailure(
      "track-store-unavailable",
      fmt::format("{}: tracks cannot be stored here ({}): start the service with --tracks FILE", file, detail)));
}

/// Whether the file holds tables, but not those that any version of this store begins with.
bool is_of_another_program(sqlite::Connection& connection, std::int64_t version) {
  if (sqlite::number(connection, "SELECT count(*) FROM sqlite_master") == 0) return false;
  return version == 0 ||
         sqlite::number(connection,
                        "SELECT count(*) FROM pragma_table_info('tracks') WHERE name IN ('id', 'client', "
                        "'request', 'map', 'map_version', 'touched_us')") != 6;
}

}  // namespace

TrackFile::TrackFile(const std::filesystem::path& path, std::int64_t max_bytes, FreeBytes free_bytes)
    : path_(path), free_bytes_(std::move(free_bytes)) {
  const std::int64_t version = with([&] {
    require_writable_folder(path_);
    connection_.emplace(path_, sqlite::Access::kCreate,
                        [this, max_bytes](const auto& file, sqlite::Failure failure, const std::string& detail) {
                          return store_error(file, failure, detail, max_bytes, free_bytes_);
                        });
    // Who holds the file holds it as long as it runs, and others ask in the meantime.
    connection_->execute("PRAGMA busy_timeout = 0; PRAGMA locking_mode = EXCLUSIVE");
    return sqlite::number(*connection_, "PRAGMA user_version");
  });
  if (with([&] { return is_of_another_program(*connection_, version); })) {
    throw IoFailure("track-store-unavailable",
                    fmt::format("{}: holds no tracks but a map or what another program wrote: start the service with "
                                "--tracks FILE",
                                path_.string()));
  }
  if (version != 0 && version != kVersion) {
    throw IoFailure("track-store-unavailable",
                    fmt::format("{}: written by another version of roadfix: move it away, or start the service with "
                                "--tracks FILE",
                                path_.string()));
  }
  with([&] {
    connection_->execute(fmt::format("PRAGMA page_size = {}; PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; "
                                     "PRAGMA max_page_count = {}",
                                     kPageBytes, std::max<std::int64_t>(1, max_bytes / kPageBytes))
                             .c_str());
    sqlite::Transaction transaction(*connection_, sqlite::Transaction::Kind::kWrite);
    connection_->execute(std::string(schema::tracks_sql()).c_str());
    connection_->execute(fmt::format("PRAGMA user_version = {}", kVersion).c_str());  // and sees that it can write
    transaction.commit();
  });
  identity_ = identity_of(path_);
  // Before a flight nothing else shows it: tracks begin in what room there is.
  const auto room = free_bytes_(path_);
  if (room && *room < kLogBytes) problem_ = full(path_, max_bytes, room).what();
}

double TrackFile::filled() {
  const auto pages = [&](const char* name) { return sqlite::number(*connection_, fmt::format("PRAGMA {}", name)); };
  const std::int64_t now = pages("page_count");
  std::int64_t most = pages("max_page_count");
  if (const auto free_bytes = free_bytes_(path_)) most = std::min(most, now + *free_bytes / kPageBytes);
  return static_cast<double>(now - pages("freelist_count")) / static_cast<double>(most);
}

void TrackFile::require_file() const {
  if (const auto problem = missing_file()) throw IoFailure("track-store-unavailable", *problem);
}

std::optional<std::string> TrackFile::problem() const {
  const std::lock_guard lock(mutex_);
  const auto missing = missing_file();
  return missing ? missing : problem_;
}

std::optional<std::string> TrackFile::missing_file() const {
  if (identity_ && identity_of(path_) == identity_) return std::nullopt;
  return fmt::format("{}: the file of the tracks was deleted or replaced: restart the service to begin a new one",
                     path_.string());
}

}  // namespace roadfix::server
