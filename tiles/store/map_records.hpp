// What a map file says about itself: settings, sources with provenance, tiles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geodesy/utm.hpp"
#include "core/grid/cell_array.hpp"
#include "core/grid/geometry.hpp"
#include "core/grid/terrain.hpp"
#include "core/units/provenance.hpp"

namespace roadfix {

inline constexpr int kTileCells = 256;

/// A tile of 256 x 256 cells on the lattice of a cell size: cells [256 col, 256 col + 256) x [256 row, ...), see
/// LatticeIndex.
struct TileIndex {
  int col = 0;
  int row = 0;
  friend auto operator<=>(const TileIndex&, const TileIndex&) = default;
};

GridGeometry tile_geometry(TileIndex tile, double cell_m);
/// Tiles that the geometry touches, row by row from the north-west.
std::vector<TileIndex> tiles_covering(const GridGeometry& geometry);

/// Fixed when a map is created.
struct MapSettings {
  UtmZone zone;
  double cell_m = 2.0;
  friend bool operator==(const MapSettings&, const MapSettings&) = default;
};

/// An ingested source and where it came from. `name` is its key: ingesting the same name again replaces it.
struct SourceRecord {
  std::string name;
  SourceContent content = SourceContent::kImagery;
  std::string location = {};  ///< path or connection string as given
  std::string fingerprint;    ///< of the content and of all settings that change the cells; guards resumption
  std::string method = {};    ///< detector or drawing rules with all parameters
  Provenance provenance = {};

  friend bool operator==(const SourceRecord&, const SourceRecord&) = default;
};

/// Names of sources in force that say the same, and so count as one where others differ.
using Witness = std::vector<std::string>;

/// The evidence of one source on some tiles, and that of others in force, fused.
struct SharedEvidence {
  struct Tile {
    CellArray own;
    CellArray others;
  };
  std::vector<Tile> tiles;
  double own_sigma_m = 0.0;     ///< the registration error that it states
  double others_sigma_m = 0.0;  ///< the largest that these others state
};

/// How far a source is shifted against the others of its map: moved back, its roads would fit theirs best.
struct SourceShift {
  double east_m = 0.0;  ///< by which the source would have to be moved
  double north_m = 0.0;
  double correlation = 0.0;  ///< Pearson's, of the cells that both observed, moved so
  double correlation_in_place = 0.0;
  double sigma_m = 0.0;  ///< registration error per axis that explains it

  friend bool operator==(const SourceShift&, const SourceShift&) = default;
};

/// A name occurs twice while a source is being replaced: the complete one is in force until the other is complete.
struct SourceStatus {
  SourceRecord record;
  bool complete = false;
  std::int64_t blocks_total = 0;
  std::int64_t blocks_done = 0;
  std::string ingested_at = {};  ///< RFC 3339, empty while incomplete
  std::optional<SourceShift> shift = {};

  /// 1 sigma per axis: what the source states, or what its shift says where that is more.
  double registration_sigma_m() const {
    return std::max(record.provenance.registration_sigma_m, shift ? shift->sigma_m : 0.0);
  }

  /// Blocks of it are missing, as verify --repair leaves it.
  bool is_damaged() const { return complete && blocks_done < blocks_total; }
};

/// As a map keeps them in memory, 32 MB: 130 x 130 km in the finest cells.
inline constexpr std::int64_t kMostTerrainCells = std::int64_t{1} << 24;

/// Where the heights of a map's ground came from. They have no registration error.
struct TerrainRecord {
  std::string location = {};  ///< paths as given, separated by ", "
  Provenance provenance = {};
  friend bool operator==(const TerrainRecord&, const TerrainRecord&) = default;
};

struct TerrainStatus {
  TerrainRecord record;
  std::string added_at = {};                    ///< RFC 3339
  HeightRange heights = {};                     ///< the lowest and the highest
  double known_share = 0.0;                     ///< of the map's extent, 0 to 1
  std::shared_ptr<const Terrain> terrain = {};  ///< never null
};

/// The extent of a map that holds nothing: empty(), but finite, so that it has a centre and makes a grid.
inline constexpr GridBox kNothingObserved{{0.0, 0.0}, {-1.0, -1.0}};

struct MapInfo {
  MapSettings settings;
  std::string version = {};  ///< changes whenever a fused cell changes
  int schema_version = 0;
  GridBox extent = {};              ///< of the observed cells; empty() for a map without any
  std::int64_t tiles = 0;           ///< of the finest level
  int levels = 0;                   ///< finest level and overviews, down to cells of 256 m
  std::int64_t pending = 0;         ///< tiles of all levels that wait to be fused: an ingest was interrupted
  double error_of_removed_m = 0.0;  ///< 1 sigma per axis, of removed sources that pending tiles still show; else 0
  std::vector<SourceStatus> sources = {};
  std::optional<TerrainStatus> terrain = {};
};

/// Of the sources of this name, complete or not, the one in force first.
std::vector<SourceRecord> records_of(const MapInfo& info, const std::string& source);

/// Which sources are incomplete, since an ingest was interrupted or is running: "source 'post': 9 of 16 blocks; ...";
/// empty if none is.
std::string missing_of(const MapInfo& info);

/// Of the complete sources together.
Provenance provenance_of(const MapInfo& info);

/// What the licences of the complete sources ask to be shown with the map: "attribution (licence)", each once,
/// separated by "; "; empty if none is known.
std::string credits_of(const MapInfo& info);

/// Of the complete sources: the detector that read the most tiles of imagery, as RoadDetector::describe() writes it;
/// nullopt where road data has more tiles than imagery.
std::optional<std::string> imagery_reader_of(const MapInfo& info);

/// Whether complete sources are imagery and others road data.
bool shows_imagery_and_roads(const MapInfo& info);

}  // namespace roadfix
