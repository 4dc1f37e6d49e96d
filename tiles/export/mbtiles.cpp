#include "tiles/export/mbtiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/units/parallel_for.hpp"
#include "tiles/export/export_failures.hpp"
#include "tiles/export/map_dataset.hpp"
#include "tiles/mercator/tile_ground.hpp"
#include "tiles/mercator/tile_picture.hpp"
#include "tiles/sources/exported_roads.hpp"
#include "tiles/store/sqlite.hpp"

namespace roadfix {
namespace {

using mercator::TileAddress;
using TileSet = std::set<TileAddress>;

/// "MPBX", of MBTiles 1.3.
constexpr const char* kTables = R"(
  PRAGMA journal_mode = OFF;
  PRAGMA application_id = 0x4d504258;
  BEGIN;
  CREATE TABLE metadata (name TEXT, value TEXT);
  CREATE TABLE tiles (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, tile_data BLOB);
  CREATE UNIQUE INDEX tile_index ON tiles (zoom_level, tile_column, tile_row);)";

/// The map as if it were no larger than the region, and had no finer cells.
MapView view_within(const MapReader& map, const GridGeometry& region) {
  const auto read = [&map, box = region.box()](const GridGeometry& asked) {
    RoadGrid grid = RoadGrid::unobserved(asked);
    if (const auto part = asked.intersection(GridGeometry::covering(box, asked.cell_m))) {
      paste(map.read(*part).cells, grid.cells, part->origin.col - asked.origin.col,
            part->origin.row - asked.origin.row);
    }
    return grid;
  };
  const MapInfo& info = map.info();
  return {{"", info.version}, info.settings.zone, region.cell_m, region.box(), {}, {}, read};
}

/// The finest ones below which the map has tiles.
TileSet finest_tiles(const MapReader& map, const MapView& view, int zoom) {
  TileSet found;
  for (const TileIndex index : map.tiles(0)) {
    const GridBox ground = intersection(tile_geometry(index, map.info().settings.cell_m).box(), view.extent);
    if (ground.empty()) continue;
    const auto tiles = mercator::tiles_on(view.zone, ground, zoom);
    found.insert(tiles.begin(), tiles.end());
  }
  return found;
}

/// By zoom, the finest first, down to that with a single one.
std::vector<TileSet> pyramid_above(TileSet finest) {
  std::vector<TileSet> zooms{std::move(finest)};
  while (zooms.back().size() > 1) {
    TileSet coarser;
    for (const TileAddress& tile : zooms.back()) coarser.insert({tile.z - 1, tile.x / 2, tile.y / 2});
    zooms.push_back(std::move(coarser));
  }
  return zooms;
}

/// With empty tables, in a transaction.
sqlite::Connection begun(const std::filesystem::path& file, const std::filesystem::path& target) {
  sqlite::Connection connection(file, sqlite::Access::kCreate,
                                [target](const std::filesystem::path&, sqlite::Failure, const std::string& detail) {
                                  return std::make_exception_ptr(cannot_be_written(target, detail));
                                });
  connection.execute(kTables);
  return connection;
}

class TileFile {
 public:
  TileFile(const std::filesystem::path& file, const std::filesystem::path& target)
      : connection_(begun(file, target)),
        insert_tile_(connection_, "INSERT INTO tiles VALUES (?1, ?2, ?3, ?4)"),
        insert_metadata_(connection_, "INSERT INTO metadata VALUES (?1, ?2)") {}

  void insert(const TileAddress& tile, const std::vector<std::byte>& png) {
    const int row = (1 << tile.z) - 1 - tile.y;  // MBTiles count from the south
    insert_tile_.with(tile.z, tile.x, row, std::span(png)).run();
  }
  void insert(const std::string& name, const std::string& value) { insert_metadata_.with(name, value).run(); }
  void commit() { connection_.execute("COMMIT"); }

 private:
  sqlite::Connection connection_;
  sqlite::Statement insert_tile_;
  sqlite::Statement insert_metadata_;
};

void write_tiles(const MapView& view, const std::vector<TileSet>& zooms, TileFile& file, const OnProgress& progress,
                 const std::stop_token& stop) {
  constexpr std::size_t kAtOnce = 64;
  std::vector<TileAddress> tiles;
  for (const TileSet& zoom : zooms) tiles.insert(tiles.end(), zoom.begin(), zoom.end());
  for (std::size_t begin = 0; begin < tiles.size(); begin += kAtOnce) {
    const auto part = std::span(tiles).subspan(begin, std::min(kAtOnce, tiles.size() - begin));
    if (progress) progress(static_cast<std::int64_t>(1000 * begin / tiles.size()), 1000);
    if (stop.stop_requested()) throw export_stopped();
    std::vector<std::optional<std::vector<std::byte>>> pictures(part.size());
    parallel_for(static_cast<int>(part.size()), processors(), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      pictures[at] = mercator::tile_png(view, part[at], mercator::TileStyle::kGrey);
    });
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (pictures[i]) file.insert(part[i], *pictures[i]);
    }
  }
}

std::string text_of(const GeoBox& box) {
  return fmt::format("{:.7f},{:.7f},{:.7f},{:.7f}", box.south_west.lon_deg, box.south_west.lat_deg,
                     box.north_east.lon_deg, box.north_east.lat_deg);
}

void write_metadata(const MapInfo& info, const MapView& view, int coarsest, int finest, TileFile& file) {
  const LatLon middle = view.zone.unproject(view.extent.centre());
  file.insert("name", "road probability");
  file.insert("format", "png");
  file.insert("type", "overlay");
  file.insert("version", "1");
  file.insert("description", description_of(info));
  file.insert("bounds", text_of(mercator::bounds_of(view)));
  file.insert("center", fmt::format("{:.7f},{:.7f},{}", middle.lon_deg, middle.lat_deg, finest));
  file.insert("minzoom", std::to_string(coarsest));
  file.insert("maxzoom", std::to_string(finest));
  for (const auto& [name, value] : provenance_items(provenance_of(info))) file.insert(name, value);
  if (const std::string credits = credits_of(info); !credits.empty()) file.insert("attribution", credits);
}

}  // namespace

void write_mbtiles(const MapReader& map, const GridGeometry& region, const std::filesystem::path& file,
                   const std::filesystem::path& target, const OnProgress& progress, const std::stop_token& stop) {
  TileFile tiles(file, target);
  const MapView view = view_within(map, region);
  const int finest = mercator::native_zoom(view);
  const std::vector<TileSet> zooms = pyramid_above(finest_tiles(map, view, finest));
  write_tiles(view, zooms, tiles, progress, stop);
  write_metadata(map.info(), view, finest + 1 - static_cast<int>(zooms.size()), finest, tiles);
  tiles.commit();
}

}  // namespace roadfix
