#include "tiles/store/map_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/units/error.hpp"
#include "core/units/parallel_for.hpp"
#include "tiles/store/file_identity.hpp"
#include "tiles/store/map_error.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/shift_table.hpp"
#include "tiles/store/source_table.hpp"
#include "tiles/store/tile_cache.hpp"
#include "tiles/store/tile_matrix.hpp"
#include "tiles/store/tile_png.hpp"

namespace roadfix {
namespace {

using sqlite::Access;
using sqlite::Connection;
using sqlite::Statement;
using sqlite::Transaction;

/// More are closed after use: each holds a descriptor and up to 2 MB of pages for as long as the map is served.
std::size_t most_idle_channels() {
  static const auto most = static_cast<std::size_t>(std::max(4, processors()));
  return most;
}

/// A connection with its prepared query serves one thread at a time.
struct Channel {
  explicit Channel(Connection connection)
      : map(std::make_unique<Connection>(std::move(connection))),
        select(*map,
               "SELECT tile_data FROM road_probability WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3"),
        data_version(*map, "PRAGMA data_version") {}
  std::unique_ptr<Connection> map;
  Statement select;
  Statement data_version;  ///< another number whenever a writer of SQLite has written to the file
  std::optional<std::int64_t> unchanged_at;
};

InUse renewed(const std::filesystem::path& map, const char* how) {
  return {"map-renewed", fmt::format("{}: {} while it was read. Try again", map.string(), how)};
}

TileCache::Tile load_tile(Channel& channel, TileIndex tile, int zoom) {
  if (!on_lattice(tile, zoom)) return nullptr;
  const sqlite::ResetAtEnd reset(channel.select);
  if (!channel.select.with(zoom, tile.col, tile_row(tile, zoom)).step()) return nullptr;
  try {
    return std::make_shared<const CellArray>(decode_tile(channel.select.blob(0), TileDepth::kFused));
  } catch (const CorruptData& error) {
    throw CorruptData(error.code(),
                      fmt::format("{}: tile zoom {} column {} row {} is damaged: {}. roadfix verify lists "
                                  "all damage",
                                  channel.map->path().string(), zoom, tile.col, tile_row(tile, zoom), error.what()));
  }
}

}  // namespace

struct MapReader::State {
  State(const std::filesystem::path& name, std::size_t cache_bytes, std::chrono::milliseconds wait)
      : path(name), patience(wait), file(identity_of(name)), looked_at(stamp_of(name)), cache(cache_bytes) {
    Channel first(open_map(path, Access::kRead, patience));
    info = read_info(*first.map);
    idle.push_back(std::move(first));
  }

  /// Runs `use` on a channel of its own, within one transaction on the map as it was opened. There are as many channels
  /// as threads read at once.
  template <typename Use>
  auto with_channel(const Use& use) {
    Channel channel = take();
    auto result = recovering(channel, [&](Channel& own) {
      return unless_copied_into([&] {
        const Transaction one_view(*own.map, Transaction::Kind::kRead);
        require_unchanged(own);
        return use(own);
      });
    });
    const std::lock_guard lock(mutex);
    if (idle.size() < most_idle_channels()) idle.push_back(std::move(channel));
    return result;
  }

  Channel take() {
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) {
        Channel channel = std::move(idle.back());
        idle.pop_back();
        return channel;
      }
    }
    Channel channel(open_map(path, Access::kRead, patience));
    if (identity_of(path) == file) return channel;
    throw renewed(path, "another file took its place");
  }

  /// Tiles read before are kept here and by callers; those of another version must not be mixed with them. Writing
  /// evidence or describing a source anew changes no tile.
  void require_unchanged(Channel& channel) const {
    const sqlite::ResetAtEnd reset(channel.data_version);
    channel.data_version.step();
    const std::int64_t now = channel.data_version.integer(0);
    if (channel.unchanged_at == now) return;
    require_same_tiles(*channel.map);
    channel.unchanged_at = now;
  }

  void require_same_tiles(Connection& map) const {
    if (read_version(map) == info->version && count_pending(map) == info->pending) return;
    throw renewed(path, "its tiles were changed");
  }

  /// Whoever copies another map into the file asks for no lock of SQLite, and where both were written to as often,
  /// SQLite goes on with the pages of the old one that it has in memory.
  template <typename Read>
  auto unless_copied_into(const Read& read) {
    require_not_copied_into();
    try {
      auto result = read();
      require_not_copied_into();
      return result;
    } catch (const CorruptData&) {
      require_not_copied_into();
      throw;
    }
  }

  /// Not within a transaction: another connection waits for a writer, and that for the end of the transaction.
  void require_not_copied_into() {
    const std::optional<FileStamp> now = stamp_of(path);
    {
      const std::lock_guard lock(mutex);
      if (now == looked_at) return;
    }
    if (now && now->identity == file) {
      Connection afresh = open_map(path, Access::kRead, patience);
      const Transaction one_view(afresh, Transaction::Kind::kRead);
      require_same_tiles(afresh);
    }
    const std::lock_guard lock(mutex);
    looked_at = now;
  }

  /// A writer may be killed while we read.
  template <typename Use>
  auto recovering(Channel& channel, const Use& use) {
    try {
      return use(channel);
    } catch (const IoFailure& error) {
      if (error.code() != kMapNeedsRecovery) throw;
      recover_map(path, patience);
      return use(channel);
    }
  }

  int zoom(int level) const { return zoom_of(info->settings.cell_m) - level; }

  TileCache::Tile tile(int level, TileIndex index) {
    return cache.get({level, index}, [&] {
      return with_channel([&](Channel& channel) { return load_tile(channel, index, zoom(level)); });
    });
  }

  std::filesystem::path path;
  std::chrono::milliseconds patience;
  std::optional<FileIdentity> file;    ///< that all channels read, even if another has the name by now
  std::optional<FileStamp> looked_at;  ///< when it held the map last; guarded by `mutex`
  std::optional<MapInfo> info;
  TileCache cache;
  std::mutex mutex;
  std::vector<Channel> idle;
};

MapReader::MapReader(const std::filesystem::path& path, std::size_t cache_bytes, std::chrono::milliseconds patience)
    : state_(std::make_unique<State>(path, cache_bytes, patience)) {}
MapReader::~MapReader() = default;
MapReader::MapReader(MapReader&&) noexcept = default;
MapReader& MapReader::operator=(MapReader&&) noexcept = default;

const MapInfo& MapReader::info() const { return *state_->info; }

RoadGrid MapReader::read(const GridGeometry& geometry) const {
  const double ratio = geometry.cell_m / info().settings.cell_m;
  int exponent = 0;
  if (!(ratio >= 1.0) || std::frexp(ratio, &exponent) != 0.5 || geometry.cell_m > cell_of_zoom(0)) {
    throw InvalidInput("cell-size-not-in-map",
                       fmt::format("{}: cells of {} m times a power of two, up to 4096 m, are possible; {} m is not",
                                   state_->path.string(), info().settings.cell_m, geometry.cell_m));
  }
  const int level = exponent - 1;
  if (level >= info().levels) {
    const GridGeometry finer{geometry.cell_m / 2.0,
                             {2 * geometry.origin.col, 2 * geometry.origin.row},
                             2 * geometry.cols,
                             2 * geometry.rows};
    return {geometry, halved(read(finer).cells)};
  }
  RoadGrid grid = RoadGrid::unobserved(geometry);
  for (const TileIndex index : tiles_covering(geometry)) {
    const auto tile = state_->tile(level, index);
    if (tile == nullptr) continue;
    paste(*tile, grid.cells, index.col * kTileCells - geometry.origin.col,
          index.row * kTileCells - geometry.origin.row);
  }
  return grid;
}

std::optional<CellArray> MapReader::tile(int level, TileIndex index) const {
  assert(level >= 0 && level < info().levels);
  const auto tile = state_->tile(level, index);
  return tile == nullptr ? std::nullopt : std::optional(*tile);
}

std::vector<TileIndex> MapReader::tiles(int level) const {
  assert(level >= 0 && level < info().levels);
  const int zoom = state_->zoom(level);
  return state_->with_channel([&](Channel& channel) {
    Statement select(
        *channel.map,
        "SELECT tile_column, tile_row FROM road_probability WHERE zoom_level = ?1 AND tile_column BETWEEN 0 "
        "AND ?2 AND tile_row BETWEEN 0 AND ?3 ORDER BY tile_row, tile_column");
    select.with(zoom, matrix_width(zoom) - 1, matrix_height(zoom) - 1);
    std::vector<TileIndex> tiles;
    while (select.step()) {
      tiles.push_back({static_cast<int>(select.integer(0)), index_row(static_cast<int>(select.integer(1)), zoom)});
    }
    return tiles;
  });
}

std::optional<double> MapReader::registration_sigma_m(const GridBox& box) const {
  const int zoom = state_->zoom(0);
  const std::vector<TileIndex> tiles = tiles_covering(GridGeometry::covering(box, info().settings.cell_m));
  const auto cols = std::ranges::minmax(tiles, {}, &TileIndex::col);
  const auto rows = std::ranges::minmax(tiles, {}, &TileIndex::row);
  return state_->with_channel([&](Channel& channel) -> std::optional<double> {
    Statement largest(
        *channel.map,
        fmt::format(
            "SELECT {} FROM roadfix_evidence e JOIN roadfix_sources s ON s.id = e.source_id WHERE s.in_force = 1 AND "
            "e.tile_column BETWEEN ?1 AND ?2 AND e.tile_row BETWEEN ?3 AND ?4 ORDER BY 1 DESC LIMIT 1",
            kRegistrationInForce));
    largest.with(cols.min.col, cols.max.col, tile_row(rows.min, zoom), tile_row(rows.max, zoom));
    const double removed_m = error_of_removed_m(*channel.map);
    if (largest.step()) return std::max(largest.real(0), removed_m);
    return removed_m > 0.0 ? std::optional(removed_m) : std::nullopt;
  });
}

std::size_t MapReader::cached_bytes() const { return state_->cache.bytes(); }

std::optional<MapInfo> info_of(const std::filesystem::path& path) {
  if (!is_there(path)) return std::nullopt;
  Connection map = open_map(path, Access::kRead);
  return read_info(map);
}

std::set<TileIndex> blocks_in_force(const std::filesystem::path& path, const std::string& source) {
  if (!is_there(path)) return {};
  Connection map = open_map(path, Access::kRead);
  SourceTable sources(map, zoom_of(read_settings(map).cell_m));
  const auto entry = sources.find(source, true);
  return entry ? sources.done_blocks(entry->id) : std::set<TileIndex>();
}

std::set<TileIndex> finished_blocks(const std::filesystem::path& path, const SourceRecord& record) {
  if (!is_there(path)) return {};
  Connection map = open_map(path, Access::kRead);
  SourceTable sources(map, zoom_of(read_settings(map).cell_m));
  for (const bool in_force : {true, false}) {
    const auto entry = sources.find(record.name, in_force);
    if (entry && entry->fingerprint == record.fingerprint) return sources.done_blocks(entry->id);
  }
  return {};
}

}  // namespace roadfix
