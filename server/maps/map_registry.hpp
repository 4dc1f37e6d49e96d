// The maps being served: every *.gpkg of a folder, in any case, that is not hidden (.city.gpkg). Of city.gpkg and
// city.GPKG the former is served. Files that appear, change or leave are noticed without a restart.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/locate/map_view.hpp"
#include "tiles/store/file_identity.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix::server {

/// A map as it was when it was opened. Requests keep it alive while a newer one takes its place.
struct ServedMap {
  std::shared_ptr<const MapReader> reader;
  MapView view;

  const std::string& name() const { return view.id.name; }
  /// Tells one look of the map from another. Its version does not: it is that of the finest cells, which are fused
  /// before the overviews.
  std::string edition() const;
};

/// A file that looks like a map and cannot be served.
struct UnreadableMap {
  std::string name;
  std::string code;
  std::string reason;
};

/// In memory, for each map.
struct MapCacheBytes {
  std::size_t tiles = std::size_t{256} << 20;     ///< decoded
  std::size_t searches = std::size_t{512} << 20;  ///< what they have built for the next ones
};

class MapRegistry {
 public:
  using OnServing = std::function<void(const ServedMap&)>;

  /// `on_serving` is called of each map that is served from then on, by whoever looks at the folder. Throws NotFound
  /// ("maps-folder-not-found") and IoFailure ("maps-folder-unreadable").
  MapRegistry(std::filesystem::path folder, MapCacheBytes cache_bytes, OnServing on_serving = {});
  ~MapRegistry();
  MapRegistry(const MapRegistry&) = delete;
  MapRegistry& operator=(const MapRegistry&) = delete;

  /// Looks at the folder now. A map that a writer keeps locked stays as it was until the next look. Throws IoFailure
  /// ("maps-folder-unreadable"); all maps stay as they were then.
  void refresh();
  /// Refreshes in a thread of its own, again and again, and calls `after_each`, which must not throw.
  void watch(std::chrono::milliseconds interval, std::function<void()> after_each = {});
  void stop();

  /// Why the last look at the folder failed; nullopt where it did not.
  std::optional<std::string> problem() const;
  std::vector<std::shared_ptr<const ServedMap>> maps() const;
  std::vector<UnreadableMap> unreadable() const;
  /// The name is the file's without .gpkg. Throws NotFound ("map-not-found"), IoFailure ("map-unreadable") with the
  /// reason, or InUse ("map-busy") of one that was locked at every look. What reads of a map waits a second for a
  /// writer that has locked it, then throws that, too.
  std::shared_ptr<const ServedMap> find(const std::string& name) const;
  std::size_t cached_bytes() const;
  std::size_t search_cached_bytes() const;

 private:
  /// What tells that a map may have changed. The date of its file does not: `cp -p` writes into a file and gives it an
  /// older one.
  struct Stamp {
    std::optional<FileStamp> file;
    std::optional<FileStamp> wal;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct Entry {
    Stamp stamp;
    std::shared_ptr<const ServedMap> map;  ///< null if unreadable
    std::optional<UnreadableMap> problem;  ///< why it is
  };
  Entry seen(const Entry& known, const std::filesystem::path& path, const Stamp& stamp) const;
  Entry opened(const std::filesystem::path& path, const Stamp& stamp) const;
  void look();
  bool is_current(const Entry& entry, const std::filesystem::path& path, const Stamp& stamp) const;
  void forget_missing(const std::map<std::string, std::filesystem::path>& present);

  const std::filesystem::path folder_;
  const MapCacheBytes cache_bytes_;
  const OnServing on_serving_;
  std::mutex refresh_mutex_;
  std::set<std::filesystem::path> left_out_;  ///< files of which it was said; changed holding `refresh_mutex_`
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::map<std::string, Entry> entries_;
  std::optional<std::string> problem_;
  std::jthread watcher_;
};

}  // namespace roadfix::server
