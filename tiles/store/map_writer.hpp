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
  /// As MapInfo has it, also of a map whose terrain is damaged.
  GridBox extent() const;

  /// The map as it is. Throws NotFound ("map-not-found") where no file is, and what the constructor does.
  static MapWriter existing(const std::filesystem::path& path);

  /// For a dry run: throws what the constructor and begin_source() would throw about the map's settings and the
  /// source's name, but writes nothing.
  static void require_acceptable(const std::filesystem::path& path, const MapSettings& settings,
                                 const SourceRecord& record, bool replace);

  /// Starts a source over these blocks (a block is one tile of the finest level) or resumes it: an incomplete source
  /// with the same name and fingerprint keeps its finished blocks, a complete one needs nothing. Another fingerprint
  /// under that name is refused (InvalidInput "source-exists") unless `replace`; the replaced evidence stays in force
  /// until finish_source(). Returns the blocks still to do, in the order given.
  std::vector<TileIndex> begin_source(const SourceRecord& record, std::span<const TileIndex> blocks, bool replace);

  /// Records finished blocks in one transaction, which waits for the disk. Call from one thread at a time. Throws
  /// InvalidInput ("block-not-expected") if begin_source() was not given one of them; none is recorded then.
  void put_blocks(const std::string& source, std::span<const FinishedBlock> blocks);

  /// Call when all blocks are done: puts the source in force, and fuses the tiles that it or the source it replaces
  /// touches, with their overviews. Can be interrupted and repeated.
  void finish_source(const std::string& source, const OnProgress& progress = {}, std::stop_token stop = {});

  /// Other sources in force that have the same cells wherever this one has any.
  std::vector<std::string> twins_of(const std::string& source);

  /// Up to `count` tiles, spread evenly over those that the source shares with the witnesses. A witness counts once,
  /// however many sources in force it consists of. Throws CorruptData naming the tile.
  SharedEvidence shared_evidence(const std::string& source, std::span<const Witness> witnesses, std::int64_t count);

  /// Other sources in force that have evidence of a tile of which this one, in force, has any.
  std::vector<std::string> sources_sharing_ground(const std::string& source);

  std::set<std::string> sources_in_force();

  /// Whether something changed since put_shifts() that shifts depend on: a source came, went or was replaced
  /// (finish_source(), remove_source()), begin_source() stated another registration error, or repair() dropped
  /// evidence.
  bool shifts_outdated();
  /// Stores how these sources in force are shifted against the others; nullopt for one that is not.
  void put_shifts(const std::map<std::string, std::optional<SourceShift>>& shifts);

  /// Removes the file if this writer made it and no block is finished, so that a first ingest that fails at once leaves
  /// no map. Nothing but the destructor may be called afterwards.
  void remove_if_new_and_empty();

  /// Takes a source out of the map, complete or not, and fuses the tiles that it touched. Can be interrupted: if called
  /// again it goes on fusing and returns false. Throws NotFound ("source-not-found") where there is neither the source
  /// nor a tile left to fuse, and shifts are not outdated.
  bool remove_source(const std::string& source, const OnProgress& progress = {}, std::stop_token stop = {});

  /// Drops evidence that cannot be decoded and fuses every tile anew from the rest. Returns the names of the sources
  /// that lost some, which count as changed from now on: ingest them again with `replace`. Readers see the map grow
  /// back meanwhile. Can be interrupted and repeated.
  std::vector<std::string> repair(const OnProgress& progress = {}, std::stop_token stop = {});

  /// Stores the heights of the ground in place of those that the map has, in one transaction. The terrain must know a
  /// cell and have at most kMostTerrainCells, on the lattice. Tiles and version of the map stay as they are.
  void put_terrain(const Terrain& terrain, const TerrainRecord& record);
  /// False where the map has none.
  bool remove_terrain();
  /// Drops tiles of heights that cannot be read, or all heights where nothing would be left. Returns what was wrong.
  std::vector<std::string> repair_terrain();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadfix
