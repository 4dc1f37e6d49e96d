#include "cli/bench/map_builder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "tests/cli/bench/bench_run.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::bench {
namespace {

using MapBuilder = BenchRun;
using As = ManifestSource::As;

TEST_F(MapBuilder, KeepsMapsOfTheSameNameApart) {
  const auto other = folder / "other";
  std::filesystem::create_directory(other);
  for (const char* file : {"town.png", "town.pgw", "town.png.aux.xml"}) {
    std::filesystem::copy_file(folder / file, other / file);
  }
  cv::imwrite(other / "town.png", cv::imread(folder / "town.png") / 2);
  const MapBuilding& building = options.maps;
  const MapView here = build_map({"town", {{folder / "town.png", As::kImagery}}}, building);
  const MapView there = build_map({"town", {{other / "town.png", As::kImagery}}}, building);
  const MapView both =
      build_map({"town", {{folder / "town.png", As::kImagery}, {other / "town.png", As::kImagery}}}, building);
  EXPECT_NE(here.id.version, there.id.version);
  EXPECT_NE(here.id.version, both.id.version);
  EXPECT_EQ(here.id.version, build_map({"town", {{folder / "town.png", As::kImagery}}}, building).id.version);
}

TEST_F(MapBuilder, TakesNeitherMapsNorTownsOfAnotherVersionOfTheProgram) {
  const ManifestMap map{"town", {{{}, As::kInvented, 3, 800.0}}};
  MapBuilding building = options.maps;
  building.version = "1";
  const std::string version = build_map(map, building).id.version;
  const auto towns = [&] {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(building.cache)) {
      if (entry.path().extension() == ".geojson") files.push_back(entry.path());
    }
    return files;
  };
  ASSERT_EQ(towns().size(), 1U);
  std::ofstream(towns().front()) << R"({"type": "FeatureCollection", "features": []})";
  EXPECT_EQ(build_map(map, building).id.version, version);
}

TEST_F(MapBuilder, GivesAMapTheHeightsOfItsGroundAsTheManifestHasThemNow) {
  write_elevation_model("dem.asc");
  const ManifestMap level{"town", {{folder / "town.png", As::kImagery}}};
  ManifestMap hills = level;
  hills.terrain = {folder / "dem.asc"};
  const GridPoint place{400'500.0, 3'999'500.0};
  const auto height_there = [&](const ManifestMap& map) -> std::optional<double> {
    const MapView view = build_map(map, options.maps);
    return view.terrain ? view.terrain->height_m(place) : std::nullopt;
  };
  EXPECT_FALSE(height_there(level));
  EXPECT_NEAR(height_there(hills).value(), height_m(place), 0.5);
  write_elevation_model("dem.asc", 50.0);
  EXPECT_NEAR(height_there(hills).value(), height_m(place) + 50.0, 0.5);
  EXPECT_FALSE(height_there(level));
  hills.terrain = {folder / "lost.asc"};
  EXPECT_EQ(testing::code_of([&] { build_map(hills, options.maps); }), "file-not-found");
}

TEST_F(MapBuilder, DoesNotReadHeightsAgainThatAMapHas) {
  write_elevation_model("dem.asc");
  const ManifestMap hills{"town", {{folder / "town.png", As::kImagery}}, {folder / "dem.asc"}};
  bool reads = false;
  options.maps.progress = [&](const std::string& what, std::int64_t, std::int64_t) { reads |= what == "terrain"; };
  build_map(hills, options.maps);
  EXPECT_TRUE(reads);
  reads = false;
  build_map(hills, options.maps);
  EXPECT_FALSE(reads);
}

TEST_F(MapBuilder, MapsBothSidesOfTheEquator) {
  std::ofstream(folder / "town.pgw") << "1\n0\n0\n-1\n400000.5\n349.5\n";
  const MapView map = build_map({"town", {{folder / "town.png", As::kImagery}}}, options.maps);
  EXPECT_FALSE(map.zone.northern());
  EXPECT_NEAR(map.extent.height_m(), 700.0, 4.0);
}

}  // namespace
}  // namespace roadfix::bench
