#include "server/tracks/track_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/units/error.hpp"
#include "server/tracks/track_file.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix::server {
namespace {

constexpr int kEndedKept = 100;          // of each kind: those that tried something out push no flight out
constexpr int kStepsHandedOut = 10'000;  // of a track that ends: some 15 MB
constexpr const char* kTrackColumns = "id, client, request, map, map_version, created_us, touched_us, ended";

std::optional<TrackEnd> end_of(std::string_view column) {
  if (column.empty()) return std::nullopt;
  return column == to_string(TrackEnd::kExpired) ? TrackEnd::kExpired : TrackEnd::kFinished;
}

StoredTrack track_of(const sqlite::Statement& row) {
  return {row.text(0),    row.text(1),    row.text(2),        {row.text(3), row.text(4)},
          row.integer(5), row.integer(6), end_of(row.text(7))};
}

void delete_steps(sqlite::Connection& connection, const std::string& id) {
  sqlite::Statement(connection, "DELETE FROM steps WHERE track = ?1").with(id).run();
}

/// The steps of the oldest of the flights that are over; false where there are none.
bool delete_oldest_history(sqlite::Connection& connection) {
  sqlite::Statement oldest(connection,
                           "SELECT id FROM tracks WHERE ended <> '' AND EXISTS (SELECT 1 FROM steps WHERE track = id) "
                           "ORDER BY end_number LIMIT 1");
  if (!oldest.step()) return false;
  const std::string id = oldest.text(0);
  oldest.reset();
  delete_steps(connection, id);
  return true;
}

/// Flights that are over give way to those that come: these have half of the room at least.
void make_room(TrackFile& file) {
  constexpr double kMostFilled = 0.5;
  while (file.filled() > kMostFilled && delete_oldest_history(file.connection())) {
  }
}

/// Does `work`, a transaction. Where there is no room for it, flights that are over give way to it.
template <typename Work>
auto with_room(sqlite::Connection& connection, Work work) -> decltype(work()) {
  for (;;) {
    try {
      return work();
    } catch (const IoFailure& error) {
      if (error.code() != kTrackStoreFull) throw;
      sqlite::Transaction transaction(connection, sqlite::Transaction::Kind::kWrite);
      if (!delete_oldest_history(connection)) throw;
      transaction.commit();
    }
  }
}

/// All that ended like this but the last kEndedKept.
void forget_ended(sqlite::Connection& connection, TrackEnd how) {
  sqlite::Statement forgotten(connection,
                              "DELETE FROM tracks WHERE ended = ?1 AND id NOT IN (SELECT id FROM tracks WHERE ended = "
                              "?1 ORDER BY end_number DESC LIMIT ?2) RETURNING id");
  std::vector<std::string> ids;
  forgotten.with(to_string(how), kEndedKept);
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

TrackStore::TrackStore(const std::filesystem::path& path, std::int64_t max_bytes, FreeBytes free_bytes)
    : file_(std::make_unique<TrackFile>(path, max_bytes, std::move(free_bytes))) {}

TrackStore::~TrackStore() = default;

std::optional<std::string> TrackStore::problem() const { return file_->problem(); }

void TrackStore::add(const StoredTrack& t) {
  file_->with([&] {
    file_->require_file();
    sqlite::Connection& connection = file_->connection();
    with_room(connection, [&] {
      sqlite::Transaction transaction(connection, sqlite::Transaction::Kind::kWrite);
      make_room(*file_);
      sqlite::Statement(connection,
                        fmt::format("INSERT INTO tracks ({}) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, '')", kTrackColumns))
          .with(t.id, t.client, t.request, t.map.name, t.map.version, t.created_us, t.touched_us)
          .run();
      transaction.commit();
    });
  });
}

std::optional<StoredTrack> TrackStore::find(const std::string& id) const {
  return file_->with([&]() -> std::optional<StoredTrack> {
    sqlite::Statement rows(file_->connection(), fmt::format("SELECT {} FROM tracks WHERE id = ?1", kTrackColumns));
    if (!rows.with(id).step()) return std::nullopt;
    return track_of(rows);
  });
}

std::vector<std::byte> TrackStore::state(const std::string& id) const {
  return file_->with([&]() -> std::vector<std::byte> {
    sqlite::Statement rows(file_->connection(), "SELECT state FROM tracks WHERE id = ?1");
    if (!rows.with(id).step()) return {};
    const auto state = rows.blob(0);
    return {state.begin(), state.end()};
  });
}

std::vector<StoredTrack> TrackStore::flying() const {
  return file_->with([&] {
    sqlite::Statement rows(
        file_->connection(),
        fmt::format("SELECT {} FROM tracks WHERE ended = '' ORDER BY created_us DESC, id", kTrackColumns));
    std::vector<StoredTrack> tracks;
    while (rows.step()) tracks.push_back(track_of(rows));
    return tracks;
  });
}

bool TrackStore::add_step(const std::string& id, std::int64_t now_us, std::span<const std::byte> state,
                          const StoredStep& step) {
  return file_->with([&] {
    file_->require_file();
    sqlite::Connection& connection = file_->connection();
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
    if (flies) file_->has_room();
    return flies;
  });
}

std::optional<StoredStep> TrackStore::step(const std::string& id, std::int64_t sequence) const {
  const std::vector<StoredStep> found = steps_after(id, sequence - 1, 1);
  if (found.empty() || found.front().sequence != sequence) return std::nullopt;
  return found.front();
}

std::optional<StoredStep> TrackStore::last_step(const std::string& id) const {
  return file_->with([&]() -> std::optional<StoredStep> {
    sqlite::Statement rows(
        file_->connection(),
        "SELECT sequence, digest, answer FROM steps WHERE track = ?1 ORDER BY sequence DESC LIMIT 1");
    if (!rows.with(id).step()) return std::nullopt;
    return step_of(rows);
  });
}

std::vector<StoredStep> TrackStore::steps_after(const std::string& id, std::int64_t sequence, int count) const {
  return file_->with([&] {
    sqlite::Statement rows(file_->connection(),
                           "SELECT sequence, digest, answer FROM steps WHERE track = ?1 AND sequence > ?2 ORDER BY "
                           "sequence LIMIT ?3");
    std::vector<StoredStep> steps;
    rows.with(id, sequence, count);
    while (rows.step()) steps.push_back(step_of(rows));
    return steps;
  });
}

std::vector<StoredStep> TrackStore::end(const std::string& id, TrackEnd how, std::optional<std::int64_t> sequence) {
  return file_->with([&] {
    sqlite::Connection& connection = file_->connection();
    std::vector<StoredStep> last = with_room(connection, [&] {
      sqlite::Transaction transaction(connection, sqlite::Transaction::Kind::kWrite);
      std::vector<StoredStep> steps;
      if (sequence) steps = last_steps(connection, id, *sequence);
      sqlite::Statement(connection,
                        "UPDATE tracks SET ended = ?2, state = NULL, end_number = (SELECT "
                        "coalesce(max(end_number), 0) + 1 FROM tracks) WHERE id = ?1 AND ended = ''")
          .with(id, to_string(how))
          .run();
      if (how == TrackEnd::kFinished) delete_steps(connection, id);
      forget_ended(connection, how);
      make_room(*file_);
      transaction.commit();
      return steps;
    });
    file_->has_room();
    return last;
  });
}

}  // namespace roadfix::server
