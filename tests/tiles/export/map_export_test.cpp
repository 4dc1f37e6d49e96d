#include "tiles/export/map_export.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/units/error.hpp"
#include "tests/tiles/export/map_export_fixture.hpp"
#include "tiles/sources/exported_roads.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using testing::ingest_plain;
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

TEST_F(MapExport, CogsHaveTheOverviewsOfTheMap) {
  constexpr int kTiles = 5;
  {
    MapWriter writer(folder / "large.gpkg", settings_37n());
    testing::ingest(writer, {"a", 1, some_blocks(kTiles)});
  }
  const MapReader map(folder / "large.gpkg");
  export_map(map, folder / "out.tif", {.format = ExportFormat::kCog});
  const Picture picture(folder / "out.tif");
  GDALRasterBand& band = *picture.data->GetRasterBand(1);
  ASSERT_EQ(band.GetOverviewCount(), 2) << "1280, 640 and 320 pixels";
  std::array<double, 6> transform{};
  picture.data->GetGeoTransform(transform.data());
  for (int i = 0; i < 2; ++i) {
    GDALRasterBand& overview = *band.GetOverview(i);
    const double cell_m = std::ldexp(2.0, i + 1);
    const GridPoint north_west{transform[0], transform[3]};
    ASSERT_EQ(std::fmod(north_west.east_m, cell_m), 0.0);
    ASSERT_EQ(std::fmod(north_west.north_m, cell_m), 0.0);
    const GridGeometry whole{cell_m, lattice_index(north_west, cell_m), overview.GetXSize(), overview.GetYSize()};
    std::vector<float> values(static_cast<std::size_t>(whole.cols) * static_cast<std::size_t>(whole.rows));
    ASSERT_EQ(overview.RasterIO(GF_Read, 0, 0, whole.cols, whole.rows, values.data(), whole.cols, whole.rows,
                                GDT_Float32, 0, 0),
              CE_None);
    const RoadGrid expected = map.read(whole);
    ASSERT_GT(expected.cells.observed_count(), values.size() / 2);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const Cell cell = expected.cells.cells()[k];
      ASSERT_NEAR(values[k], is_observed(cell) ? probability(cell) : -1.0, 1e-6) << k;
    }
  }
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

TEST_F(MapExport, LeavesTheGapBetweenDistantTownsOut) {
  const TileIndex here = some_blocks(1).front();
  const TileIndex there{here.col + 100, here.row + 100};  // 72 km off: 25,600 x 25,600 cells
  ingest_plain(folder / "two.gpkg", settings_37n(), {{here, 40}, {there, 80}});
  for (const auto& [name, format, most_bytes] : {std::tuple("cog.tif", ExportFormat::kCog, 300'000U),
                                                 {"plain.tif", ExportFormat::kGeoTiff, 300'000U},
                                                 {"out.mbtiles", ExportFormat::kMbTiles, 100'000U}}) {
    export_map(MapReader(folder / "two.gpkg"), folder / name, {.format = format});
    EXPECT_LT(fs::file_size(folder / name), most_bytes) << name;
  }
  const Picture picture(folder / "cog.tif");
  const auto value = [&](int at) {
    float read = 0.0F;
    EXPECT_EQ(picture.data->GetRasterBand(1)->RasterIO(GF_Read, at, at, 1, 1, &read, 1, 1, GDT_Float32, 0, 0), CE_None);
    return read;
  };
  EXPECT_FLOAT_EQ(value(100), 40.0F / 254.0F);
  EXPECT_FLOAT_EQ(value(12'000), -1.0F);
  EXPECT_FLOAT_EQ(value(25'700), 80.0F / 254.0F);
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
