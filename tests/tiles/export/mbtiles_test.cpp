// Maps as MBTiles.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/decoded_png.hpp"
#include "tests/tiles/export/map_export_fixture.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using testing::ingest_plain;
using testing::MapExport;
using testing::open_sqlite;
using testing::settings_37n;
using testing::some_blocks;

TEST_F(MapExport, MbTilesTakeNothingFromTheFileThatTheyReplace) {
  const auto target = folder / "out.mbtiles";
  export_map(MapReader(path), target, {.format = ExportFormat::kMbTiles});
  {
    sqlite::Connection killed = open_sqlite(target);
    killed.execute("UPDATE tiles SET tile_data = 'of before'");
    killed.execute("PRAGMA cache_size = 1; BEGIN; UPDATE tiles SET tile_data = zeroblob(50000)");
    fs::copy_file(target.string() + "-journal", folder / "journal");
  }
  fs::rename(folder / "journal", target.string() + "-journal");
  export_map(MapReader(path), target, {.format = ExportFormat::kMbTiles});
  sqlite::Connection file = open_sqlite(target);
  EXPECT_EQ(sqlite::number(file, "SELECT count(*) FROM tiles WHERE tile_data = 'of before'"), 0);
  EXPECT_EQ(files(), 2U);
}

TEST_F(MapExport, MbTilesCoverTheMapAtAllZooms) {
  const auto target = folder / "out.mbtiles";
  export_map(MapReader(path), target, {.format = ExportFormat::kMbTiles});
  EXPECT_EQ(files(), 2U);
  const DatasetPtr picture(GDALDataset::Open(target.c_str(), GDAL_OF_RASTER));
  ASSERT_NE(picture, nullptr);
  EXPECT_STREQ(picture->GetSpatialRef()->GetAuthorityCode(nullptr), "3857");
  EXPECT_EQ(picture->GetRasterCount(), 4);
  const auto zoom = [&](const char* name) { return std::stoi(picture->GetMetadataItem(name)); };
  sqlite::Connection tiles = open_sqlite(target);
  EXPECT_EQ(sqlite::number(tiles, "SELECT max(zoom_level) FROM tiles"), zoom("maxzoom"));
  EXPECT_EQ(sqlite::number(tiles, "SELECT min(zoom_level) FROM tiles"), zoom("minzoom"));
  EXPECT_EQ(sqlite::number(tiles, "SELECT count(DISTINCT zoom_level) FROM tiles"),
            zoom("maxzoom") + 1 - zoom("minzoom"));
  EXPECT_EQ(sqlite::number(tiles, fmt::format("SELECT count(*) FROM tiles WHERE zoom_level = {}", zoom("minzoom"))), 1);
}

/// Grey and alpha of the most detailed tile at a place.
std::pair<int, int> shown_at(sqlite::Connection& tiles, LatLon place) {
  const auto zoom = static_cast<int>(sqlite::number(tiles, "SELECT value FROM metadata WHERE name = 'maxzoom'"));
  const double across = std::exp2(zoom);
  const double x = (place.lon_deg + 180.0) / 360.0 * across;
  const double lat = place.lat_deg * std::numbers::pi / 180.0;
  const double y_from_south = (1.0 + std::asinh(std::tan(lat)) / std::numbers::pi) / 2.0 * across;
  sqlite::Statement tile(tiles,
                         "SELECT tile_data FROM tiles WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3");
  if (!tile.with(zoom, std::floor(x), std::floor(y_from_south)).step()) return {-1, -1};
  const cv::Mat picture = testing::decoded_png(tile.blob(0));
  const auto pixel = [](double tiles_along) {
    return static_cast<int>((tiles_along - std::floor(tiles_along)) * 256.0);
  };
  const auto& shown = picture.at<cv::Vec4b>(255 - pixel(y_from_south), pixel(x));
  return {shown[0], shown[3]};
}

TEST_F(MapExport, MbTilesShowTheMapWhereItLiesAlsoOnBothSidesOf180Degrees) {
  for (const auto& [epsg, place] :
       {std::pair{32637, LatLon{37.8, 38.3}}, {32701, {-16.8, 180.0}}, {32760, {-16.8, 180.0}}}) {
    const UtmZone zone = *UtmZone::from_epsg(epsg);
    const GridPoint at = zone.project(place);
    const TileIndex middle{static_cast<int>(std::floor(at.east_m / 512.0)),
                           static_cast<int>(std::floor(-at.north_m / 512.0))};
    const auto beside = [&](int east, int south) { return TileIndex{middle.col + east, middle.row + south}; };
    const std::vector<std::pair<TileIndex, Cell>> blocks{
        {beside(-1, 0), 254}, {middle, 10}, {beside(1, 0), 130}, {beside(3, 1), 77}};
    const fs::path file = folder / fmt::format("{}.gpkg", epsg);
    ingest_plain(file, {zone, 2.0}, blocks);
    const fs::path target = folder / "out.mbtiles";
    export_map(MapReader(file), target, {.format = ExportFormat::kMbTiles});
    sqlite::Connection tiles = open_sqlite(target);
    const auto shown = [&](TileIndex block) {
      return shown_at(tiles, zone.unproject(tile_geometry(block, 2.0).box().centre()));
    };
    for (const auto& [block, value] : blocks) EXPECT_EQ(shown(block), std::pair(int{value}, 255)) << epsg;
    EXPECT_LE(shown(beside(2, 0)).second, 0) << epsg;
  }
}

TEST_F(MapExport, MbTilesOfARegionInCoarserCellsShowThatRegion) {
  const TileIndex west = some_blocks(1).front();
  const TileIndex east{west.col + 1, west.row};
  ingest_plain(folder / "two.gpkg", settings_37n(), {{west, 40}, {east, 80}});
  const fs::path target = folder / "out.mbtiles";
  const auto zoom = [&](const ExportOptions& options) {
    export_map(MapReader(folder / "two.gpkg"), target, options);
    sqlite::Connection tiles = open_sqlite(target);
    return sqlite::number(tiles, "SELECT max(zoom_level) FROM tiles");
  };
  const auto finest = zoom({.format = ExportFormat::kMbTiles});
  const GridBox region = tile_geometry(east, 2.0).box();
  EXPECT_EQ(zoom({.format = ExportFormat::kMbTiles, .box = region, .cell_m = 8.0}), finest - 2);
  sqlite::Connection tiles = open_sqlite(target);
  const auto shown = [&](TileIndex block) {
    return shown_at(tiles, settings_37n().zone.unproject(tile_geometry(block, 2.0).box().centre()));
  };
  EXPECT_EQ(shown(east), (std::pair{80, 255}));
  EXPECT_LE(shown(west).second, 0);
}

}  // namespace
}  // namespace roadfix
