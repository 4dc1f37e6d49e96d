// Other programs see what we wrote: a map opened by GDAL's own GeoPackage driver.
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <array>
#include <memory>
#include <vector>

#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/store/map_verifier.hpp"

namespace roadfix {
namespace {

using testing::put_block;
using testing::random_cells;
using testing::TemporaryFolder;
using testing::TestSource;

class MapInGdal : public ::testing::TestWithParam<int> {};

TEST_P(MapInGdal, IsARasterOfProbabilitiesInPlaceWithNoData) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  const MapSettings settings{*UtmZone::from_epsg(GetParam()), 2.0};
  const TileIndex block{847, settings.zone.northern() ? -8165 : -12100};
  CellArray cells = random_cells(7, block);
  for (int row = 0; row < 10; ++row) std::ranges::fill(cells.row(row), kUnobserved);  // an extent within the tile
  cells.at(100, 10) = kRoad;
  cells.at(0, 255) = cells.at(255, 255) = kNoRoad;
  {
    MapWriter writer(path, settings);
    writer.begin_source(TestSource{"a", 1, {}}.record(), std::vector{block}, false);
    put_block(writer, "a", block, cells);
    writer.finish_source("a");
  }
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> data(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  ASSERT_NE(data, nullptr);
  EXPECT_STREQ(data->GetSpatialRef()->GetAuthorityCode(nullptr), std::to_string(GetParam()).c_str());
  std::array<double, 6> transform{};
  data->GetGeoTransform(transform.data());
  const GridBox box = MapReader(path).info().extent;
  EXPECT_EQ(transform[0], box.min.east_m);
  EXPECT_EQ(transform[3], box.max.north_m);
  EXPECT_EQ(transform[1], 2.0);
  ASSERT_EQ(data->GetRasterXSize(), 256);
  ASSERT_EQ(data->GetRasterYSize(), 246);

  GDALRasterBand* band = data->GetRasterBand(1);
  EXPECT_EQ(band->GetRasterDataType(), GDT_Float32);
  int has_no_data = 0;
  const auto no_data = static_cast<float>(band->GetNoDataValue(&has_no_data));
  ASSERT_NE(has_no_data, 0);
  std::vector<float> values(std::size_t{256} * 246);
  ASSERT_EQ(band->RasterIO(GF_Read, 0, 0, 256, 246, values.data(), 256, 246, GDT_Float32, 0, 0), CE_None);
  for (int row = 0; row < 246; ++row) {
    for (int col = 0; col < 256; ++col) {
      const float value = values[static_cast<std::size_t>(row * 256 + col)];
      const Cell cell = cells.at(col, row + 10);
      if (is_observed(cell)) {
        ASSERT_NEAR(static_cast<double>(value), probability(cell), 1e-6);
      } else {
        ASSERT_EQ(value, no_data);
      }
    }
  }
}

TEST(MapInGdalAndBack, OverviewsThatGdalHasBuiltAreMadeAnewByRepair) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  MapWriter writer(path, testing::settings_37n());
  testing::ingest(writer, {"a", 1, testing::some_blocks(2)});
  const auto before = testing::tile_bytes(path);
  {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> data(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    std::array<int, 2> factors{2, 4};
    ASSERT_EQ(data->BuildOverviews("NEAREST", 2, factors.data(), 0, nullptr, nullptr, nullptr), CE_None);
  }
  const std::vector<MapProblem> problems = verify_map(path).problems;
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems.front().code, "ancillary-wrong");
  EXPECT_THAT(problems.front().what, ::testing::HasSubstr("--repair"));
  writer.repair();
  EXPECT_TRUE(verify_map(path).problems.empty());
  EXPECT_EQ(testing::tile_bytes(path), before);
}

/// With an empty gpkg_geometry_columns GDAL would take our own tables for layers too, and QGIS ask which of them to
/// show.
TEST(MapInGdalAndBack, IsOneRasterAndNoVectors) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  MapWriter writer(path, testing::settings_37n());
  testing::ingest(writer, {"a", 1, testing::some_blocks(1)});
  GDALAllRegister();
  for (const bool with_terrain : {false, true}) {
    if (with_terrain) writer.put_terrain({{32.0, {13'552, -130'640}, 1, 1}, {8000}}, {.location = "heights.tif"});
    const std::unique_ptr<GDALDataset> vectors(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR));
    EXPECT_EQ(vectors == nullptr ? 0 : vectors->GetLayerCount(), 0);
    const std::unique_ptr<GDALDataset> raster(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
    ASSERT_NE(raster, nullptr);
    EXPECT_EQ(raster->GetRasterCount(), 1);
    EXPECT_EQ(raster->GetMetadata("SUBDATASETS"), nullptr);
  }
}

INSTANTIATE_TEST_SUITE_P(NorthAndSouth, MapInGdal, ::testing::Values(32637, 32734));

}  // namespace
}  // namespace roadfix
