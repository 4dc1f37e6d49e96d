// What each source of a map file says (table roadfix_evidence), tile by tile. Shared by the writer's steps; not for
// other modules.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "tiles/store/map_records.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {

/// A tile of the finest level, as the file counts them, of which a source says something.
struct EvidencePlace {
  std::string source;
  std::int64_t column = 0;
  std::int64_t row = 0;
};
/// Throws CorruptData that names the map and the place.
CellArray decoded_evidence(const std::filesystem::path& map, const EvidencePlace& place,
                           std::span<const std::byte> png);

class EvidenceTable {
 public:
  EvidenceTable(sqlite::Connection& map, int finest_zoom);

  /// Stores what a source says of a block and marks it as done; nothing is stored of a block without an observed cell.
  /// False where the ledger of the source does not have the block. Part of the caller's transaction.
  bool put(std::int64_t source_id, TileIndex block, const CellArray& cells);
  /// These three: see MapWriter.
  std::vector<std::string> twins_of(const std::string& source);
  SharedEvidence shared_evidence(const std::string& source, std::span<const Witness> witnesses, std::int64_t count);
  std::vector<std::string> sources_sharing_ground(const std::string& source);
  /// Drops evidence that cannot be read, or that belongs to no block that the ledger calls done. Returns the sources
  /// that lost some, each once; their fingerprints are cleared, since they are no longer what was ingested. Part of the
  /// caller's transaction.
  std::vector<std::string> drop_damaged();

 private:
  /// Those of the source in force of which any of the witnesses says something, too, row by row.
  std::vector<EvidencePlace> places_shared(const std::string& source, std::span<const Witness> witnesses);

  sqlite::Connection& map_;
  int zoom_;
  sqlite::Statement put_;
  sqlite::Statement remove_;
  sqlite::Statement mark_done_;
};

}  // namespace roadfix
