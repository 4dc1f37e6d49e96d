#include "server/tracks/track_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <limits>
#include <mutex>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/units/error.hpp"
#include "schema/schema.hpp"
#include "tiles/store/file_identity.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix::server {
namespace {

constexpr std::int64_t kPageBytes = 4096;
constexpr std::int64_t kMiB = 1 << 20;
constexpr int kEndedKept = 100;
constexpr int kStepsHandedOut = 10'000;  // of a track that ends: some 15 MB
constexpr int kVersion = 4;              // of what a state holds, too
constexpr const char* kStoreFull = "track-store-full";
constexpr const char* kTrackColumns = "id, client, request, map, map_version, created_us, touched_us, ended";

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

/// SQLite does not tell a full disk from its own limit: whoever reads this can.
IoFailure full(const std::filesystem::path& path, std::int64_t max_bytes) {
  return {kStoreFull,
          fmt::format("{}: no space left for the tracks (serve --tracks-size allows {} MiB, and its disk has {} MiB "
                      "free): nothing was changed; end tracks or make room, then send the request again",
                      path.string(), max_bytes / kMiB, free_bytes_beside(path) / kMiB)};
}

/// What a refusal of SQLite means for this store, which may have `max_bytes`.
std::exception_ptr store_error(const std::filesystem::path& path, sqlite::Failure failure, const std::string& detail,
                               std::int64_t max_bytes) {
  using sqlite::Failure;
  using std::make_exception_ptr;
  const std::string file = path.string();
  switch (failure) {
    case Failure::kFull:
      return make_exception_ptr(full(path, max_bytes));
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

const char* end_column(std::optional<TrackEnd> end) { return end ? to_string(*end) : ""; }

std::optional<TrackEnd> end_of(std::string_view column) {
  if (column.empty()) return std::nullopt;
  return column == to_string(TrackEnd::kExpired) ? TrackEnd::kExpired : TrackEnd::kFinished;
}

StoredTrack track_of(const sqlite::Statement& row) {
  return {row.text(0), row.text(1),    row.text(2),    row.text(3),
          row.text(4), row.integer(5), row.integer(6), end_of(row.text(7))};
}

/// How far the file, as large as it may become on a disk with so much room, is filled, 0 to 1, as `connection` sees it.
double filled(sqlite::Connection& connection, std::int64_t free_bytes) {
  const auto pages = [&](const char* name) { return sqlite::number(connection, fmt::format("PRAGMA {}", name)); };
  const std::int64_t now = pages("page_count");
  const std::int64_t most = std::min(pages("max_page_count"), now + free_bytes / kPageBytes);
  return static_cast<double>(now - pages("freelist_count")) / static_cast<double>(most);
}

void delete_steps(sqlite::Connection& connection, const std::string& id) {
  sqlite::Statement(connection, "DELETE FROM steps WHERE track = ?1").with(id).run();
}

/// The steps of the oldest of the flights that are over; false where there are none.
bool delete_oldest_history(sqlite::Connection& connection) {
  sqlite::Statement oldest(connection,
                           "SELECT id FROM tracks WHERE ended <> '' AND EXISTS (SELECT 1 FROM steps WHERE track = id) "
                           "ORDER BY touched_us, id LIMIT 1");
  if (!oldest.step()) return false;
  const std::string id = oldest.text(0);
  oldest.reset();
  delete_steps(connection, id);
  return true;
}

/// Flights that are over give way to those that come: these have half of the room at least.
void make_room(sqlite::Connection& connection, std::int64_t free_bytes) {
  constexpr double kMostFilled = 0.5;
  while (filled(connection, free_bytes) > kMostFilled && delete_oldest_history(connection)) {
  }
}

/// Does `work`, a transaction. Where there is no room for it, flights that are over give way to it.
template <typename Work>
auto with_room(sqlite::Connection& connection, Work work) -> decltype(work()) {
  for (;;) {
    try {
      return work();
    } catch (const IoFailure& error) {
      if (error.code() != kStoreFull) throw;
      sqlite::Transaction transaction(connection, sqlite::Transaction::Kind::kWrite);
      if (!delete_oldest_history(connection)) throw;
      transaction.commit();
    }
  }
}

/// All but the last kEndedKept.
void forget_ended(sqlite::Connection& connection) {
  sqlite::Statement forgotten(connection,
                              "DELETE FROM tracks WHERE ended <> '' AND id NOT IN (SELECT id FROM tracks WHERE ended "
                              "<> '' ORDER BY touched_us DESC, id LIMIT ?1) RETURNING id");
  std::vector<std::string> ids;
  forgotten.with(kEndedKept);
  while (forgotten.step()) ids.push_back(forgotten.text(0));
  for (const std::string& id : ids) delete_steps(connection, id);
}

StoredStep step_of(const sqlite::Statement& row) { return {row.integer(0), row.integer(1), row.text(2)}; }

/// Above the sequence number, in order.
std::vector<StoredStep> last_steps(sqlite::Connection& connection, const std::string& id, std::int64_t sequence) {
  sqlite::Statement rows(connection,
                         "SELECT sequence, digest, answer FROM steps WHERE track = ?1 AND sequence > ?2 ORDER BY "
                         "sequence DESC LIMIT ?3");
  rows.with(id, sequence, kStepsHandedOut);
  std::vector<StoredStep> last;
  while (rows.step()) last.push_back(step_of(rows));
  std::ranges::reverse(last);
  return last;
}

}  // namespace

const char* to_string(TrackEnd end) { return end == TrackEnd::kExpired ? "expired" : "finished"; }

class TrackStore::Impl {
 public:
  Impl(const std::filesystem::path& path, std::int64_t max_bytes, FreeBytes free_bytes)
      : path_(path), free_bytes_(std::move(free_bytes)) {
    const std::int64_t version = with([&] {
      require_writable_folder(path_);
      connection_.emplace(path_, sqlite::Access::kCreate,
                          [max_bytes](const auto& file, sqlite::Failure failure, const std::string& detail) {
                            return store_error(file, failure, detail, max_bytes);
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
  }

  /// Of work that is to write: SQLite goes on with a file that was deleted, and what it writes there is lost at the end
  /// of the process. Throws IoFailure "track-store-unavailable".
  void require_file() const {
    if (const auto problem = missing_file()) throw IoFailure("track-store-unavailable", *problem);
  }

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
  sqlite::Connection& connection() { return *connection_; }
  std::int64_t free_bytes() const { return free_bytes_(path_); }
  /// Of work that runs: what failed before is over. A track that begins is too small to show that.
  void has_room() { problem_.reset(); }
  std::optional<std::string> problem() const {
    const std::lock_guard lock(mutex_);
    const auto missing = missing_file();
    return missing ? missing : problem_;
  }

 private:
  std::optional<std::string> missing_file() const {
    if (identity_ && identity_of(path_) == identity_) return std::nullopt;
    return fmt::format("{}: the file of the tracks was deleted or replaced: restart the service to begin a new one",
                       path_.string());
  }

  const std::filesystem::path path_;
  const FreeBytes free_bytes_;
  mutable std::mutex mutex_;
  std::optional<sqlite::Connection> connection_;
  std::optional<FileIdentity> identity_;  ///< of the file when it was opened
  std::optional<std::string> problem_;
};

std::int64_t free_bytes_beside(const std::filesystem::path& file) {
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::space(file, unknown).available;
  return unknown ? std::numeric_limits<std::int64_t>::max() : static_cast<std::int64_t>(bytes);
}

TrackStore::TrackStore(const std::filesystem::path& path, std::int64_t max_bytes, FreeBytes free_bytes)
    : impl_(std::make_unique<Impl>(path, max_bytes, std::move(free_bytes))) {}

TrackStore::~TrackStore() = default;

std::optional<std::string> TrackStore::problem() const { return impl_->problem(); }

void TrackStore::add(const StoredTrack& t) {
  impl_->with([&] {
    impl_->require_file();
    sqlite::Connection& connection = impl_->connection();
    with_room(connection, [&] {
      sqlite::Transaction transaction(connection, sqlite::Transaction::Kind::kWrite);
      make_room(connection, impl_->free_bytes());
      sqlite::Statement(connection,
                        fmt::format("INSERT INTO tracks ({}) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)", kTrackColumns))
          .with(t.id, t.client, t.request, t.map, t.map_version, t.created_us, t.touched_us, end_column(t.ended))
          .run();
      transaction.commit();
    });
  });
}

std::optional<StoredTrack> TrackStore::find(const std::string& id) const {
  return impl_->with([&]() -> std::optional<StoredTrack> {
    sqlite::Statement rows(impl_->connection(), fmt::format("SELECT {} FROM tracks WHERE id = ?1", kTrackColumns));
    if (!rows.with(id).step()) return std::nullopt;
    return track_of(rows);
  });
}

std::vector<std::byte> TrackStore::state(const std::string& id) const {
  return impl_->with([&]() -> std::vector<std::byte> {
    sqlite::Statement rows(impl_->connection(), "SELECT state FROM tracks WHERE id = ?1");
    if (!rows.with(id).step()) return {};
    const auto state = rows.blob(0);
    return {state.begin(), state.end()};
  });
}

std::vector<StoredTrack> TrackStore::flying() const {
  return impl_->with([&] {
    sqlite::Statement rows(
        impl_->connection(),
        fmt::format("SELECT {} FROM tracks WHERE ended = '' ORDER BY created_us DESC, id", kTrackColumns));
    std::vector<StoredTrack> tracks;
    while (rows.step()) tracks.push_back(track_of(rows));
    return tracks;
  });
}

bool TrackStore::add_step(const std::string& id, std::int64_t now_us, std::span<const std::byte> state,
                          const StoredStep& step) {
  return impl_->with([&] {
    impl_->require_file();
    sqlite::Connection& connection = impl_->connection();
    const bool flies = with_room(connection, [&] {
      sqlite::Transaction transaction(connection, sqlite::Transaction::Kind::kWrite);
      sqlite::Statement update(
          connection, "UPDATE tracks SET touched_us = ?2, state = ?3 WHERE id = ?1 AND ended = '' RETURNING 1");
      if (!update.with(id, now_us, state).step()) return false;
      update.reset();
      sqlite::Statement(connection, "INSERT INTO steps (track, sequence, digest, answer) VALUES (?1, ?2, ?3, ?4)")
          .with(id, step.sequence, step.digest, step.answer)
          .run();
      transaction.commit();
      return true;
    });
    if (flies) impl_->has_room();
    return flies;
  });
}

std::optional<StoredStep> TrackStore::step(const std::string& id, std::int64_t sequence) const {
  const std::vector<StoredStep> found = steps_after(id, sequence - 1, 1);
  if (found.empty() || found.front().sequence != sequence) return std::nullopt;
  return found.front();
}

std::optional<StoredStep> TrackStore::last_step(const std::string& id) const {
  return impl_->with([&]() -> std::optional<StoredStep> {
    sqlite::Statement rows(
        impl_->connection(),
        "SELECT sequence, digest, answer FROM steps WHERE track = ?1 ORDER BY sequence DESC LIMIT 1");
    if (!rows.with(id).step()) return std::nullopt;
    return step_of(rows);
  });
}

std::vector<StoredStep> TrackStore::steps_after(const std::string& id, std::int64_t sequence, int count) const {
  return impl_->with([&] {
    sqlite::Statement rows(impl_->connection(),
                           "SELECT sequence, digest, answer FROM steps WHERE track = ?1 AND sequence > ?2 ORDER BY "
                           "sequence LIMIT ?3");
    std::vector<StoredStep> steps;
    rows.with(id, sequence, count);
    while (rows.step()) steps.push_back(step_of(rows));
    return steps;
  });
}

std::vector<StoredStep> TrackStore::end(const std::string& id, TrackEnd how, std::optional<std::int64_t> sequence) {
  return impl_->with([&] {
    sqlite::Connection& connection = impl_->connection();
    std::vector<StoredStep> last = with_room(connection, [&] {
      sqlite::Transaction transaction(connection, sqlite::Transaction::Kind::kWrite);
      std::vector<StoredStep> steps;
      if (sequence) steps = last_steps(connection, id, *sequence);
      sqlite::Statement(connection, "UPDATE tracks SET ended = ?2, state = NULL WHERE id = ?1 AND ended = ''")
          .with(id, end_column(how))
          .run();
      if (how == TrackEnd::kFinished) delete_steps(connection, id);
      forget_ended(connection);
      make_room(connection, impl_->free_bytes());
      transaction.commit();
      return steps;
    });
    impl_->has_room();
    return last;
  });
}

}  // namespace roadfix::server
