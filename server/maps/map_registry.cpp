#include "server/maps/map_registry.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "tiles/view/map_file_view.hpp"

namespace roadfix::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".gpkg";
constexpr const char* kBusy = "map-busy";

/// A request or a look at the folder waits so long for a writer: both are repeated, and others wait behind them.
constexpr std::chrono::seconds kLockPatience{1};

/// By its name. Those that begin with a dot are hidden: copies under way, and what a Mac keeps beside a file
/// (._city.gpkg).
bool is_called_a_map(const fs::path& path) {
  return lower_case(path.extension().native()) == kExtension && !path.native().starts_with('.');
}

/// A link that leads nowhere is one too: whoever made it waits for a map.
bool is_file(const fs::directory_entry& entry) {
  std::error_code gone;
  return entry.is_regular_file(gone) || (entry.is_symlink(gone) && !fs::exists(entry.status(gone)));
}

struct MapFiles {
  std::map<std::string, fs::path> of_name;
  std::set<fs::path> left_out;  ///< another one is called the same but for the case of its extension
};

MapFiles map_files(const fs::path& folder) {
  std::error_code refused;
  const fs::directory_iterator entries(folder, refused);
  if (refused) {
    throw IoFailure("maps-folder-unreadable",
                    fmt::format("--maps {}: {}; the service must be able to list and enter this folder",
                                folder.string(), refused.message()));
  }
  MapFiles files;
  for (const auto& entry : entries) {
    if (!is_called_a_map(entry.path().filename()) || !is_file(entry)) continue;
    const auto [known, is_new] = files.of_name.emplace(entry.path().stem(), entry.path());
    if (is_new) continue;
    fs::path other = entry.path();
    if (known->second < other) known->second.swap(other);  // small letters, the usual ones, come last
    files.left_out.insert(std::move(other));
  }
  return files;
}

/// Of all that is served of a map. How many blocks of a source are done is not: an ingest under way shall not cost the
/// decoded tiles again and again.
bool says_the_same(const MapInfo& a, const MapInfo& b) {
  const auto alike = [](const SourceStatus& x, const SourceStatus& y) {
    return x.record == y.record && x.complete == y.complete && x.ingested_at == y.ingested_at && x.shift == y.shift;
  };
  const bool same_terrain = a.terrain && b.terrain
                                ? a.terrain->record == b.terrain->record && a.terrain->added_at == b.terrain->added_at
                                : a.terrain.has_value() == b.terrain.has_value();
  return a.version == b.version && a.pending == b.pending && same_terrain &&
         std::ranges::equal(a.sources, b.sources, alike);
}

}  // namespace

std::string ServedMap::edition() const { return fmt::format("{}-{}", view.id.version, reader->info().pending); }

MapRegistry::MapRegistry(fs::path folder, MapCacheBytes cache_bytes, OnServing on_serving)
    : folder_(std::move(folder)), cache_bytes_(cache_bytes), on_serving_(std::move(on_serving)) {
  std::error_code unseen;
  const fs::file_type type = fs::status(folder_, unseen).type();
  if (type != fs::file_type::directory && type != fs::file_type::none) {  // none: refresh() says why it is not seen
    throw NotFound("maps-folder-not-found",
                   fmt::format("--maps {} is not a folder; name the folder with the maps", folder_.string()));
  }
  refresh();
  if (entries_.empty()) spdlog::warn("no map (*{}) is in {} yet", kExtension, folder_.string());
}

MapRegistry::~MapRegistry() { stop(); }

void MapRegistry::watch(std::chrono::milliseconds interval, std::function<void()> after_each) {
  watcher_ = std::jthread([this, interval, after_each = std::move(after_each)](std::stop_token stop) {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
      const std::optional<std::string> before = problem_;
      lock.unlock();
      try {
        refresh();
        if (before) spdlog::info("the maps folder {} can be read again", folder_.string());
      } catch (const std::exception& error) {
        if (error.what() != before)
          spdlog::error("the maps folder {} cannot be read: {}", folder_.string(), error.what());
      }
      if (after_each) after_each();
      lock.lock();
    }
  });
}

void MapRegistry::stop() {
  if (!watcher_.joinable()) return;
  watcher_.request_stop();
  watcher_.join();
}

MapRegistry::Entry MapRegistry::seen(const Entry& known, const fs::path& path, const Stamp& stamp) const {
  try {
    return is_current(known, path, stamp) ? Entry{stamp, known.map, std::nullopt} : opened(path, stamp);
  } catch (const InUse& busy) {
    if (known.map != nullptr) return known;  // and its stamp, so that the next look goes on
    return {stamp, nullptr, UnreadableMap{path.stem(), busy.code(), busy.what()}};
  }
}

MapRegistry::Entry MapRegistry::opened(const fs::path& path, const Stamp& stamp) const {
  const std::string name = path.stem();
  try {
    const auto reader = std::make_shared<const MapReader>(path, cache_bytes_.tiles, kLockPatience);
    auto map = std::make_shared<const ServedMap>(ServedMap{reader, view_of(reader, name, cache_bytes_.searches)});
    spdlog::info("serving map {} version {}", name, reader->info().version);
    const std::string missing = missing_of(reader->info());
    if (!missing.empty()) spdlog::warn("map {} lacks what an ingest has not brought yet ({})", name, missing);
    if (on_serving_) on_serving_(*map);
    return {stamp, std::move(map), std::nullopt};
  } catch (const InUse&) {
    throw;
  } catch (const Error& error) {
    return {stamp, nullptr, UnreadableMap{name, error.code(), error.what()}};
  }
}

/// A touched file that says the same keeps its reader and with it the decoded tiles. One that could not be read may be
/// readable now, though nothing was written to it: other permissions do not show.
bool MapRegistry::is_current(const Entry& entry, const fs::path& path, const Stamp& stamp) const {
  if (entry.map == nullptr) return false;
  if (entry.stamp == stamp) return true;
  if (!entry.stamp.file || !stamp.file || entry.stamp.file->identity != stamp.file->identity) return false;
  try {
    return says_the_same(MapReader(path, 0, kLockPatience).info(), entry.map->reader->info());
  } catch (const InUse&) {
    throw;
  } catch (const Error&) {
    return false;  // opened() finds the same and reports it
  }
}

void MapRegistry::forget_missing(const std::map<std::string, fs::path>& present) {
  std::map<std::string, Entry> missing;  // freed when all others need not wait for it
  {
    const std::lock_guard lock(mutex_);
    for (auto item = entries_.begin(); item != entries_.end();) {
      const auto known = item++;
      if (!present.contains(known->first)) missing.insert(entries_.extract(known));
    }
  }
  for (const auto& [name, entry] : missing) spdlog::info("map {} was removed from the folder", name);
}

void MapRegistry::refresh() {
  const std::lock_guard one_at_a_time(refresh_mutex_);
  try {
    look();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    problem_ = error.what();
    throw;
  }
  const std::lock_guard lock(mutex_);
  problem_.reset();
}

void MapRegistry::look() {
  const MapFiles files = map_files(folder_);
  for (const fs::path& path : files.left_out) {
    if (left_out_.contains(path)) continue;
    spdlog::warn("{} is not served: another file of the folder is called so but for the case of {}; rename it",
                 path.string(), kExtension);
  }
  left_out_ = files.left_out;
  for (const auto& [name, path] : files.of_name) {
    const Stamp stamp{stamp_of(path), stamp_of(path.string() + "-wal")};
    Entry known;  // outlives the lock in which another takes its place: to free a map may take long
    {
      const std::lock_guard lock(mutex_);
      const auto found = entries_.find(name);
      if (found != entries_.end()) known = found->second;
    }
    Entry current = seen(known, path, stamp);
    if (current.problem && !(known.problem && known.problem->reason == current.problem->reason)) {
      spdlog::warn("map {} cannot be served: {} [{}]", name, current.problem->reason, current.problem->code);
    }
    const std::lock_guard lock(mutex_);
    entries_[name] = std::move(current);
  }
  forget_missing(files.of_name);
}

std::optional<std::string> MapRegistry::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

std::vector<std::shared_ptr<const ServedMap>> MapRegistry::maps() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<const ServedMap>> result;
  for (const auto& [name, entry] : entries_) {
    if (entry.map != nullptr) result.push_back(entry.map);
  }
  return result;
}

std::vector<UnreadableMap> MapRegistry::unreadable() const {
  const std::lock_guard lock(mutex_);
  std::vector<UnreadableMap> result;
  for (const auto& [name, entry] : entries_) {
    if (entry.problem) result.push_back(*entry.problem);
  }
  return result;
}

std::shared_ptr<const ServedMap> MapRegistry::find(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(name);
  if (found == entries_.end()) {
    throw NotFound("map-not-found", fmt::format("no map is called '{}'; GET /v1/maps lists them", name.substr(0, 80)));
  }
  const auto& [stamp, map, problem] = found->second;
  if (!problem) return map;
  if (problem->code == kBusy) throw InUse(kBusy, problem->reason);
  throw IoFailure("map-unreadable", fmt::format("the map '{}' cannot be read: {}", name, problem->reason));
}

std::size_t MapRegistry::cached_bytes() const {
  std::size_t bytes = 0;
  for (const auto& map : maps()) bytes += map->reader->cached_bytes();
  return bytes;
}

std::size_t MapRegistry::search_cached_bytes() const {
  std::size_t bytes = 0;
  for (const auto& map : maps()) bytes += map->view.searches ? map->view.searches->bytes() : 0;
  return bytes;
}

}  // namespace roadfix::server
