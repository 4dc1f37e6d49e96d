#include "tiles/sources/vector_file.hpp"

#include <gtest/gtest.h>

#include <stop_token>

#include "tests/support/code_of.hpp"
#include "tests/tiles/sources/road_features.hpp"

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
