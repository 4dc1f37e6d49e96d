// The sources of a map file with their ledgers. Shared by the writer's steps; not for other modules.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

class SourceTable {
 public:
  SourceTable(sqlite::Connection& map, int finest_zoom);

  struct Entry {
    std::int64_t id = 0;
    std::string fingerprint;
    SourceContent content = SourceContent::kImagery;
    std::string method;
    double registration_sigma_m = 0.0;
  };
  /// At most one source of a name is in force, and at most one is on its way to be.
  std::optional<Entry> find(const std::string& name, bool in_force);
  /// A source on its way, without provenance or blocks. Returns its id.
  std::int64_t insert(const SourceRecord& record);
  void set_provenance(std::int64_t id, const SourceRecord& record);
  /// By name; of one name that in force first.
  std::vector<SourceStatus> all();
  /// Their ids and names.
  std::vector<std::pair<std::int64_t, std::string>> in_force();
  /// The ledger holds exactly these blocks; what was done stays done.
  void set_ledger(std::int64_t id, std::span<const TileIndex> blocks);
  std::set<TileIndex> done_blocks(std::int64_t id);
  /// Throws InvalidInput ("source-incomplete").
  void require_complete(std::int64_t id, const std::string& name);
  /// From now on, in place of one of the same name, which has to be removed.
  void put_in_force(std::int64_t id);
  /// Removes the source, its ledger and its evidence.
  void remove(std::int64_t id);

 private:
  sqlite::Connection& map_;
  int zoom_;
};

}  // namespace roadfix
