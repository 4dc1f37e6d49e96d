#include "tiles/view/map_file_view.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <tuple>
#include <vector>

#include "core/locate/fix.hpp"
#include "core/units/error.hpp"
#include "tests/support/map_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

TEST(MapFileView, AMapFileAnswersWhereAFootprintWasSeen) {
  const RoadGrid town = testing::street_map(31, {2.0, {300'100, -3'200'050}, 700, 600});
  const testing::TemporaryFolder folder;
  testing::write_map_file(folder / "town.gpkg", town, 1.5);
  const MapView view = view_of(std::make_shared<MapReader>(folder / "town.gpkg"), "town");
  EXPECT_EQ(view.id.name, "town");
  EXPECT_FALSE(view.id.version.empty());
  EXPECT_EQ(view.registration_sigma_m(town.geometry.box().centre()), 1.5);

  std::mt19937_64 random(32);
  const GridPose truth{{600'900.0, 6'399'300.0}, Angle::degrees(123.0)};
  const Fix fix = locate(view, testing::observed_at(town, truth, 170, 170, 2.0, {0.1, 0.1}, random), {}, {});
  ASSERT_EQ(fix.status, FixStatus::kFix) << fix.reason;
  EXPECT_LT(distance_m(view.zone.project(fix.modes[0].pose.position), truth.position), 1.5);
  EXPECT_GT(fix.modes[0].ellipse.sigma_m[1], 1.5) << "the registration error of the map is part of the answer's";
  EXPECT_EQ(fix.map.version, view.id.version);
}

TEST(MapFileView, HasTheHeightsOfItsGroundWhereTheMapHasThem) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path path = folder / "town.gpkg";
  testing::write_map_file(path, testing::street_map(31, {2.0, {300'100, -3'200'050}, 100, 100}), 1.5);
  EXPECT_EQ(view_of_file(path).terrain, nullptr);
  Terrain terrain = Terrain::unknown({32.0, {18'756, -200'004}, 8, 8});
  terrain.codes[9] = Terrain::code_of(812.0);
  MapWriter::existing(path).put_terrain(terrain, {.location = "heights.tif"});
  const MapView view = view_of_file(path);
  ASSERT_NE(view.terrain, nullptr);
  EXPECT_EQ(*view.terrain, terrain);
}

TEST(MapFileView, ASourceCountsForTheAccuracyOfTheGroundAroundItOnly) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path path = folder / "town.gpkg";
  const RoadGrid town = testing::street_map(31, {2.0, {300'100, -3'200'050}, 700, 600});
  testing::write_map_file(path, town, 1.5);
  {
    MapWriter writer(path, {UtmZone::from_epsg(32634).value(), 2.0});
    const SourceRecord coarse{.name = "coarse",
                              .content = SourceContent::kRoads,
                              .location = "coarse.geojson",
                              .fingerprint = "coarse",
                              .method = "drawn",
                              .provenance = {.registration_sigma_m = 40.0}};
    const GridGeometry far{2.0, {310'000, -3'200'050}, 1, 1};
    for (const TileIndex block : writer.begin_source(coarse, tiles_covering(far), false)) {
      testing::put_block(writer, coarse.name, block, CellArray(kTileCells, kTileCells, kNoRoad));
    }
    writer.finish_source(coarse.name);
  }
  const MapView view = view_of(std::make_shared<MapReader>(path), "town");
  EXPECT_EQ(view.registration_sigma_m(town.geometry.box().centre()), 1.5);
  EXPECT_EQ(view.registration_sigma_m({620'000.0, 6'400'100.0}), 40.0);
  EXPECT_EQ(view.registration_sigma_m({640'000.0, 6'400'100.0}), 40.0) << "beyond all sources";
}

TEST(MapFileView, CountsTheErrorOfASourceThatWasReplacedWhereTilesStillShowIt) {
  const testing::TemporaryFolder folder;
  const auto path = folder / "town.gpkg";
  MapWriter writer(path, testing::settings_37n());
  const auto put = [&](double sigma_m, std::uint64_t seed, std::stop_token stop) {
    SourceRecord record = testing::TestSource{"a", seed, {}}.record();
    record.provenance.registration_sigma_m = sigma_m;
    for (const TileIndex block : writer.begin_source(record, testing::some_blocks(1), seed > 1)) {
      testing::put_block(writer, "a", block, testing::random_cells(seed, block));
    }
    writer.finish_source("a", {}, stop);
  };
  put(40.0, 1, {});
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_THROW(put(2.0, 2, stopped.get_token()), Interrupted);
  EXPECT_EQ(view_of_file(path).registration_sigma_m({434'000.0, 4'180'000.0}), 40.0);
  writer.finish_source("a");
  EXPECT_EQ(view_of_file(path).registration_sigma_m({434'000.0, 4'180'000.0}), 2.0);
}

/// Sources "kind method tiles" of the map, one south of the other.
MapView view_of_sources(std::initializer_list<std::tuple<const char*, const char*, int>> sources) {
  const testing::TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", testing::settings_37n());
  int row = -8165;
  for (const auto& [kind, method, tiles] : sources) {
    SourceRecord record = testing::TestSource{std::to_string(row), 1, {}}.record();
    record.content = value_of(kSourceContents, kind).value();
    record.method = method;
    std::vector<TileIndex> blocks;
    for (int col = 0; col < tiles; ++col) blocks.push_back({847 + col, row});
    for (const TileIndex block : writer.begin_source(record, blocks, false)) {
      testing::put_block(writer, record.name, block, testing::random_cells(1, block));
    }
    writer.finish_source(record.name);
    ++row;
  }
  return view_of_file(folder / "m.gpkg");
}

std::optional<std::string> imagery_reader(std::initializer_list<std::tuple<const char*, const char*, int>> sources) {
  return view_of_sources(sources).imagery_reader;
}

TEST(MapFileView, NamesTheDetectorThatReadMostOfTheImagery) {
  EXPECT_EQ(imagery_reader({{"imagery", "neural a; pixels of 1 m", 2}, {"imagery", "neural b; pixels of 1 m", 3}}),
            "neural b");
  EXPECT_EQ(imagery_reader({{"imagery", "neural a; pixels of 1 m", 2},
                            {"imagery", "neural b; pixels of 1 m", 3},
                            {"imagery", "neural a; pixels of 0.5 m", 2}}),
            "neural a");
}

TEST(MapFileView, TellsWhetherImageryAndRoadDataAreInIt) {
  EXPECT_FALSE(view_of_sources({{"imagery", "neural a; 1", 2}, {"imagery", "neural b; 1", 1}}).imagery_and_roads);
  EXPECT_FALSE(view_of_sources({{"roads", "drawn", 1}}).imagery_and_roads);
  EXPECT_TRUE(view_of_sources({{"roads", "drawn", 1}, {"imagery", "neural a; 1", 5}}).imagery_and_roads);
}

TEST(MapFileView, NamesNoDetectorWhereMoreTilesShowRoadDataThanImagery) {
  EXPECT_EQ(imagery_reader({{"roads", "drawn roads 0.9 elsewhere 0.1", 3}}), std::nullopt);
  EXPECT_EQ(imagery_reader({{"roads", "drawn roads 0.9 elsewhere 0.1", 3}, {"imagery", "neural a; 1", 2}}),
            std::nullopt);
  EXPECT_EQ(imagery_reader({{"roads", "drawn roads 0.9 elsewhere 0.1", 2}, {"imagery", "neural a; 1", 2}}), "neural a");
}

}  // namespace
}  // namespace roadfix
