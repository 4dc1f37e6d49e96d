#include "tiles/export/map_export.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>

#include "core/geodesy/geo_box.hpp"
#include "core/units/error.hpp"
#include "tests/tiles/export/map_export_fixture.hpp"
#include "tiles/sources/exported_roads.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using testing::ingest;
using testing::MapExport;
using testing::settings_37n;
using testing::some_blocks;

struct Picture {
  explicit Picture(const fs::path& path) : data(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER)) {
    EXPECT_NE(data, nullptr);
  }
  int cols() const { return data->GetRasterXSize(); }
  int rows() const { return data->GetRasterYSize(); }
  std::vector<float> band(int number) const {
    std::vector<float> values(static_cast<std::size_t>(cols()) * static_cast<std::size_t>(rows()));
    EXPECT_EQ(data->GetRasterBand(number)->RasterIO(GF_Read, 0, 0, cols(), rows(), values.data(), cols(), rows(),
                                                    GDT_Float32, 0, 0),
              CE_None);
    return values;
  }
  std::unique_ptr<GDALDataset> data;
};

/// The file holds these cells at this place.
void expect_probabilities(const Picture& picture, const RoadGrid& grid) {
  ASSERT_EQ(picture.cols(), grid.geometry.cols);
  ASSERT_EQ(picture.rows(), grid.geometry.rows);
  std::array<double, 6> transform{};
  picture.data->GetGeoTransform(transform.data());
  EXPECT_EQ(transform[0], grid.geometry.box().min.east_m);
  EXPECT_EQ(transform[3], grid.geometry.box().max.north_m);
  EXPECT_EQ(transform[1], grid.geometry.cell_m);
  EXPECT_STREQ(picture.data->GetSpatialRef()->GetAuthorityCode(nullptr), "32637");
  const double no_data = picture.data->GetRasterBand(1)->GetNoDataValue();
  const auto values = picture.band(1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Cell cell = grid.cells.cells()[i];
    const double expected = is_observed(cell) ? probability(cell) : no_data;
    ASSERT_NEAR(static_cast<double>(values[i]), expected, 1e-6) << i;
  }
}

TEST_F(MapExport, GeoTiffsHoldTheProbabilitiesInPlace) {
  const MapReader map(path);
  const RoadGrid whole = map.read(GridGeometry::covering(map.info().extent, 2.0));
  for (const auto format : {ExportFormat::kCog, ExportFormat::kGeoTiff}) {
    const auto target = folder / "out.tif";
    export_map(map, target, {.format = format});
    expect_probabilities(Picture(target), whole);
  }
  EXPECT_EQ(files(), 2U);
}

TEST_F(MapExport, ARegionInCoarserCellsIsThatOfTheOverview) {
  const MapReader map(path);
  const GridBox extent = map.info().extent;
  const GridBox box{{extent.min.east_m + 101, extent.min.north_m + 55},
                    {extent.max.east_m - 3, extent.max.north_m - 9}};
  const auto target = folder / "out.tif";
  export_map(map, target, {.format = ExportFormat::kGeoTiff, .box = box, .cell_m = 8.0});
  expect_probabilities(Picture(target), map.read(GridGeometry::covering(box, 8.0)));
}

TEST_F(MapExport, PngsAreGreyAndTransparentWhereUnobserved) {
  const MapReader map(path);
  const auto target = folder / "out.png";
  export_map(map, target, {.format = ExportFormat::kPng});
  EXPECT_TRUE(fs::exists(folder / "out.wld"));
  EXPECT_EQ(files(), 4U) << "map, picture, world file and reference system";
  const Picture picture(target);
  ASSERT_NE(picture.data->GetSpatialRef(), nullptr);
  EXPECT_STREQ(picture.data->GetSpatialRef()->GetAuthorityCode(nullptr), "32637");
  const auto grey = picture.band(1);
  const auto alpha = picture.band(2);
  const RoadGrid whole = map.read(GridGeometry::covering(map.info().extent, 2.0));
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const Cell cell = whole.cells.cells()[i];
    ASSERT_EQ(alpha[i], is_observed(cell) ? 255.0F : 0.0F);
    ASSERT_EQ(grey[i], is_observed(cell) ? static_cast<float>(cell) : 0.0F);
  }
}

TEST_F(MapExport, WhatOtherProgramsLeftBesideAReplacedFileIsRemoved) {
  const auto target = folder / "out.png";
  export_map(MapReader(path), target, {.format = ExportFormat::kPng});
  for (const char* suffix : {".ovr", ".aux.xml"}) std::ofstream(target.string() + suffix) << "of the old picture";
  export_map(MapReader(path), target, {.format = ExportFormat::kPng});
  EXPECT_EQ(files(), 4U) << "map, picture, world file and its own reference system";
  EXPECT_NE(Picture(target).data->GetSpatialRef(), nullptr);
}

TEST_F(MapExport, APictureLiesWhereItsMapDoesWhereverTheOneBeforeLay) {
  const char* place = "9\n0\n0\n-9\n1\n2\n";
  for (const char* name : {"out.pgw", "out.PGW", "out.pngw", "out.wld"}) std::ofstream(folder / name) << place;
  export_map(MapReader(path), folder / "out.png", {.format = ExportFormat::kPng});
  EXPECT_EQ(files(), 4U) << "map, picture, its own world file and reference system";
  std::array<double, 6> transform{};
  Picture(folder / "out.png").data->GetGeoTransform(transform.data());
  EXPECT_EQ(transform[1], 2.0);

  std::ofstream(folder / "out.tfw") << place;
  export_map(MapReader(path), folder / "out.tif", {.format = ExportFormat::kCog});
  EXPECT_FALSE(fs::exists(folder / "out.tfw"));
  EXPECT_TRUE(fs::exists(folder / "out.wld")) << "of the PNG beside it";
}

TEST_F(MapExport, MbTilesTakeNothingFromTheFileThatTheyReplace) {
  const auto target = folder / "out.mbtiles";
  export_map(MapReader(path), target, {.format = ExportFormat::kMbTiles});
  {
    sqlite::Connection killed = testing::open_sqlite(target);
    killed.execute("UPDATE tiles SET tile_data = 'of before'");
    killed.execute("PRAGMA cache_size = 1; BEGIN; UPDATE tiles SET tile_data = zeroblob(50000)");
    fs::copy_file(target.string() + "-journal", folder / "journal");
  }
  fs::rename(folder / "journal", target.string() + "-journal");
  export_map(MapReader(path), target, {.format = ExportFormat::kMbTiles});
  sqlite::Connection file = testing::open_sqlite(target);
  EXPECT_EQ(sqlite::number(file, "SELECT count(*) FROM tiles WHERE tile_data = 'of before'"), 0);
  EXPECT_EQ(files(), 2U);
}

TEST_F(MapExport, MbTilesCoverTheMapAtAllZooms) {
  const auto target = folder / "out.mbtiles";
  export_map(MapReader(path), target, {.format = ExportFormat::kMbTiles});
  const Picture picture(target);
  EXPECT_STREQ(picture.data->GetSpatialRef()->GetAuthorityCode(nullptr), "3857");
  EXPECT_EQ(picture.data->GetRasterCount(), 4);
  EXPECT_EQ(files(), 2U);
  GDALRasterBand& band = *picture.data->GetRasterBand(1);
  ASSERT_GE(band.GetOverviewCount(), 1);
  GDALRasterBand& smallest = *band.GetOverview(band.GetOverviewCount() - 1);
  EXPECT_LE(std::max(smallest.GetXSize(), smallest.GetYSize()), 256);
  const auto zoom = [&](const char* name) { return std::stoi(picture.data->GetMetadataItem(name)); };
  EXPECT_EQ(zoom("minzoom"), zoom("maxzoom") - band.GetOverviewCount());
}

/// Of numbers "W,S,E,N" behind the n-th "--bbox " of a text.
GeoBox proposed_box(const std::string& text, int number) {
  std::size_t at = 0;
  for (int i = 0; i <= number; ++i) at = text.find("--bbox ", at) + 7;
  GeoBox box;
  EXPECT_EQ(std::sscanf(text.c_str() + at, "%lf,%lf,%lf,%lf", &box.south_west.lon_deg, &box.south_west.lat_deg,
                        &box.north_east.lon_deg, &box.north_east.lat_deg),
            4);
  return box;
}

TEST_F(MapExport, MbTilesOnBothSidesOf180DegreesAreRefusedAndEitherSideIsNot) {
  for (const int epsg : {32701, 32760}) {  // of Fiji: a map of either zone
    const UtmZone zone = *UtmZone::from_epsg(epsg);
    const fs::path across = folder / fmt::format("{}.gpkg", epsg);
    {
      const GridPoint at = zone.project({-16.8, 180.0});
      const auto block = [](double metres) { return static_cast<int>(std::floor(metres / 512.0)); };
      MapWriter writer(across, {zone, 2.0});
      testing::TestSource source{"a", 1, {}};
      for (const int east : {-1, 0, 1}) {
        source.blocks.push_back({block(at.east_m) + east, -block(at.north_m)});
      }
      ingest(writer, source);
    }
    const MapReader map(across);
    const fs::path target = folder / "out.mbtiles";
    std::string text;
    try {
      export_map(map, target, {.format = ExportFormat::kMbTiles});
    } catch (const InvalidInput& error) {
      EXPECT_EQ(error.code(), "region-across-antimeridian");
      text = error.what();
    }
    ASSERT_FALSE(text.empty());
    for (const int side : {0, 1}) {
      const GridBox box = grid_box_around(zone, proposed_box(text, side), map.info().extent);
      export_map(map, target, {.format = ExportFormat::kMbTiles, .box = box});
      EXPECT_GT(box.width_m(), 400.0) << text;
      EXPECT_LT(Picture(target).cols(), 2048) << text;
    }
    const double between_deg =
        proposed_box(text, 1).south_west.lon_deg + 360.0 - proposed_box(text, 0).north_east.lon_deg;
    const double between_m = between_deg * 111'320.0 * std::cos(16.8 / 180.0 * std::numbers::pi);
    double said_m = 0.0;
    EXPECT_EQ(std::sscanf(text.c_str() + text.find("a strip of"), "a strip of %lf m", &said_m), 1) << text;
    EXPECT_NEAR(said_m, between_m, 1.0);
    EXPECT_EQ(code_of(folder / "out.tif", {}), "no error");
  }
}

TEST_F(MapExport, SaysWhoseTheContentIs) {
  EXPECT_EQ(credits_of(MapReader(path).info()), "someone (CC BY 4.0)");
  for (const auto& [name, attribution, licence] : {std::array{"b", "OSM contributors", "ODbL 1.0"},
                                                   {"c", "OSM contributors", "ODbL 1.0"},
                                                   {"d", "OSM", ""},
                                                   {"e", "", "CC0"}}) {
    MapWriter writer(path, settings_37n());
    SourceRecord record = testing::TestSource{name, 1, {}}.record();
    record.provenance.attribution = attribution;
    record.provenance.licence = licence;
    for (const TileIndex block : writer.begin_source(record, some_blocks(1), false)) {
      testing::put_block(writer, name, block, testing::random_cells(1, block));
    }
    writer.finish_source(name);
  }
  const MapReader map(path);
  const std::string credits = "someone (CC BY 4.0); OSM contributors (ODbL 1.0); OSM; CC0";
  EXPECT_EQ(credits_of(map.info()), credits);
  const auto item_of = [&](const char* name, ExportFormat format, const char* item) -> std::string {
    export_map(map, folder / name, {.format = format});
    const Picture picture(folder / name);
    const char* value = picture.data->GetMetadataItem(item);
    return value == nullptr ? "none" : value;
  };
  EXPECT_EQ(item_of("out.tif", ExportFormat::kCog, "TIFFTAG_COPYRIGHT"), credits);
  EXPECT_EQ(item_of("plain.tif", ExportFormat::kGeoTiff, "TIFFTAG_COPYRIGHT"), credits);
  EXPECT_EQ(item_of("out.png", ExportFormat::kPng, "Copyright"), credits);
  EXPECT_EQ(item_of("out.mbtiles", ExportFormat::kMbTiles, "attribution"), credits);
  EXPECT_THAT(item_of("out.mbtiles", ExportFormat::kMbTiles, "description"), ::testing::HasSubstr(map.info().version));
}

TEST_F(MapExport, TellsIngestDateLicenceAttributionAndRegistrationError) {
  const MapReader map(path);
  for (const auto& [name, format] : {std::pair("cog.tif", ExportFormat::kCog),
                                     {"plain.tif", ExportFormat::kGeoTiff},
                                     {"out.png", ExportFormat::kPng},
                                     {"out.mbtiles", ExportFormat::kMbTiles}}) {
    export_map(map, folder / name, {.format = format});
    fs::remove(folder / (std::string(name) + ".aux.xml"));
    const Picture picture(folder / name);
    EXPECT_EQ(provenance_in(*picture.data), (Provenance{"2023-02-06", "CC BY 4.0", "someone", 2.5})) << name;
  }
}

}  // namespace
}  // namespace roadfix
