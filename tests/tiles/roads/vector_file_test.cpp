#include "tiles/roads/vector_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stop_token>
#include <string>
#include <vector>

#include "tests/support/code_of.hpp"
#include "tests/tiles/roads/road_features.hpp"

namespace roadfix {
namespace {

class VectorFileTest : public testing::RoadFeatures {};

TEST_F(VectorFileTest, EndsItsReadingOnceItIsAskedTo) {
  const std::string path = geojson({road(0, 0), road(50, 0), road(100, 0)});
  std::stop_source stop;
  VectorOptions options;
  options.stop = stop.get_token();
  VectorFile file(path, options);
  int seen = 0;
  const auto read = [&] {
    file.for_each_feature([&](OGRLayer&, OGRFeature&) {
      if (++seen == 2) stop.request_stop();
    });
  };
  EXPECT_EQ(testing::code_of(read), "work-stopped");
  EXPECT_EQ(seen, 2);
}

struct Told {
  std::vector<std::int64_t> done;
  std::int64_t total = 0;
};

Told told_while_reading(const std::vector<std::string>& paths) {
  Told told;
  VectorOptions options;
  options.on_reading = [&](std::int64_t done, std::int64_t total) {
    told.done.push_back(done);
    told.total = total;
  };
  read_road_network(paths, options, RoadRules(), testing::kZone);
  return told;
}

TEST_F(VectorFileTest, TellsHowManyOfItsFeaturesWereRead) {
  const Told told = told_while_reading({geojson({road(0, 0), road(50, 0), road(100, 0), road(150, 0)})});
  EXPECT_EQ(told.total, 1000);
  EXPECT_EQ(told.done, (std::vector<std::int64_t>{250, 500, 750, 1000}));
}

TEST_F(VectorFileTest, TellsHowMuchOfAnOpenStreetMapFileWasRead) {
  const std::string path = (folder / "trees.osm").string();
  {
    std::ofstream file(path);
    file << "<?xml version='1.0'?><osm version='0.6'>";
    for (int i = 1; i <= 30000; ++i) {
      file << fmt::format("<node id='{}' version='1' lat='37.{:05}' lon='38'><tag k='natural' v='tree'/></node>", i, i);
    }
    file << "<way id='1' version='1'><nd ref='1'/><nd ref='99'/><tag k='highway' v='track'/></way></osm>";
  }
  const Told told = told_while_reading({path});
  EXPECT_EQ(told.done.back(), 1000);
  EXPECT_TRUE(std::ranges::is_sorted(told.done));
  EXPECT_TRUE(std::ranges::any_of(told.done, [](std::int64_t done) { return done > 100 && done < 900; }));
}

TEST_F(VectorFileTest, CountsEachOfSeveralFilesByItsSize) {
  const std::string large = geojson({road(0, 0), road(50, 0), road(100, 0)});
  const std::string small = (folder / "small.geojson").string();
  std::ofstream(small) << R"({"type":"FeatureCollection","features":[)" << road(200, 0) << "]}";
  const auto bytes = [](const std::string& path) { return static_cast<double>(std::filesystem::file_size(path)); };
  const Told told = told_while_reading({large, small});
  ASSERT_EQ(told.done.size(), 4U);
  EXPECT_NEAR(static_cast<double>(told.done[2]), 1000.0 * bytes(large) / (bytes(large) + bytes(small)), 1.0);
  EXPECT_EQ(told.done[3], 1000);
}

TEST(VectorTileName, TellsZoomColumnAndRow) {
  for (const char* path : {"a/12-1407-2471.mvt", "12-1407-2471.mvt", "tiles/12/1407/2471.pbf"}) {
    const auto tile = vector_tile_of(path);
    ASSERT_TRUE(tile) << path;
    EXPECT_EQ(tile->zoom, 12);
    EXPECT_EQ(tile->x, 1407);
    EXPECT_EQ(tile->y, 2471);
  }
  for (const char* path : {"monaco.osm.pbf", "2-9-1.mvt", "12-1407.mvt", "99-1-1.mvt", "x12-1-1.mvt"}) {
    EXPECT_FALSE(vector_tile_of(path)) << path;
  }
}

}  // namespace
}  // namespace roadfix
