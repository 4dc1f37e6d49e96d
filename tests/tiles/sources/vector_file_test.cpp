#include "tiles/sources/vector_file.hpp"

#include <gtest/gtest.h>

namespace roadfix {
namespace {

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
