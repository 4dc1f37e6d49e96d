// Writes a map file. Every source keeps its own evidence; the fused map is derived from it, whatever the order of
// ingestion. Transactions hold whole blocks: killing the process anywhere loses at most the blocks in flight.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/units/progress.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix {

struct FinishedBlock {
  TileIndex index;
  CellArray cells;  ///< 256 x 256; all unobserved is fine
};

class MapWriter {
 public:
  /// Opens the map or creates it with the settings. Throws InvalidInput when an existing map has other settings, is not
  /// ours or is from a newer version; InUse ("map-in-use") when another writer holds it.
  MapWriter(const std::filesystem::path& path, const MapSettings& settings);
  ~MapWriter();
  MapWriter(MapWriter&&) noexcept;
  MapWriter& operator=(MapWriter&&) noexcept;

  const MapSettings& settings() const;

  /// The map as it is. Throws NotFound ("map-not-found") where no file is, and what the constructor does.
  static MapWriter existing(const std::filesystem::path& path);

  /// Throws what the constructor and begin_source() would throw about the map's settings and the source's name, but
  /// writes nothing: for a plan.
  static void require_acceptable(const std::filesystem::path& path, const MapSettings& settings,
                                 const SourceRecord& record, bool replace);

  /// Starts a source over these blocks (a block is one tile of the finest level) or resumes it: an incomplete source
  /// with the same name and fingerprint keeps its finished blocks. A complete one with the same name and fingerprint
  /// needs nothing. Another fingerprint under that name is refused (InvalidInput "source-exists") unless `replace`. The
  /// replaced evidence stays in force until finish_source. Returns the blocks still to do, in the order given.
  std::vector<TileIndex> begin_source(const SourceRecord& record, std::span<const TileIndex> blocks, bool replace);

  /// Records finished blocks in one transaction: each of these waits for the disk. Call from one thread at a time.
  /// Throws InvalidInput ("block-not-expected") where the source has not begun with one of them; none is recorded then.
  void put_blocks(const std::string& source, std::span<const FinishedBlock> blocks);

  /// All blocks are there: puts the source in force, fuses the tiles it (or what it replaced) touches and their
  /// overviews. Can be interrupted and repeated.
  void finish_source(const std::string& source, const OnProgress& progress = {}, std::stop_token stop = {});

  /// Sources in force, other than this one, that say the same wherever it says anything, cell by cell.
  std::vector<std::string> twins_of(const std::string& source);

  /// Of up to `count` tiles, spread evenly over those that the source shares with the witnesses, of which each counts
  /// once, however many sources in force it is. Throws CorruptData naming the tile.
  SharedEvidence shared_evidence(const std::string& source, std::span<const Witness> witnesses, std::int64_t count);

  /// Other sources in force that say something of a tile that this one in force does, too.
  std::vector<std::string> sources_beside(const std::string& source);

  std::set<std::string> sources_in_force();

  /// Whether sources came, went or were replaced since put_shifts(), so that any of those in force may lie beside the
  /// others or not by now: finish_source() or remove_source() was stopped, or what should follow it. So they may where
  /// begin_source() states another registration error, or repair() drops evidence.
  bool shifts_outdated();
  /// Tells the map which of these sources in force lie beside the others; nullopt for one that does not.
  void put_shifts(const std::map<std::string, std::optional<SourceShift>>& shifts);

  /// Removes the file where this writer made it and no block was finished since: a first ingest that failed at once
  /// leaves no map. Nothing but the destructor may be called afterwards.
  void remove_if_new_and_empty();

  /// Takes a source out of the map, complete or not, and fuses what it touched. Can be interrupted and repeated: then
  /// it only goes on fusing, and returns false. Throws NotFound ("source-not-found") where nothing is left to fuse, nor
  /// shifts_outdated().
  bool remove_source(const std::string& source, const OnProgress& progress = {}, std::stop_token stop = {});

  /// Fuses every tile anew from the evidence. Evidence that cannot be decoded is dropped first; returns the names of
  /// the sources that lost some, which count as changed from now on: ingest them again with `replace`. Readers see the
  /// map grow back meanwhile. Can be interrupted and repeated.
  std::vector<std::string> repair(const OnProgress& progress = {}, std::stop_token stop = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadfix
