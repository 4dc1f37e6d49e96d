#include "tiles/world/corridor.hpp"

#include <gmock/gmock.h>

#include "tests/tiles/world/small_country.hpp"

namespace roadfix::world {
namespace {

using testing::empty_country;

Corridor river_of_10_m() {
  Corridor river(empty_country(200.0));
  river.add({{100, -50}, {100, 250}}, 10.0);
  return river;
}

TEST(Corridor, ContainsWhatLiesAlongItsLines) {
  const Corridor river = river_of_10_m();
  EXPECT_TRUE(river.contains({100, 20}));
  EXPECT_TRUE(river.contains({104, -30}));
  EXPECT_FALSE(river.contains({108, 20}));
  EXPECT_FALSE(river.contains({100, 1000})) << "outside the raster";
}

TEST(Corridor, ContainsAreas) {
  Corridor pond(empty_country(200.0));
  pond.add_area({{20, 20}, {60, 20}, {60, 60}, {20, 60}});
  EXPECT_TRUE(pond.contains({40, 40}));
  EXPECT_FALSE(pond.contains({80, 40}));
}

TEST(Corridor, TellsHowFarAwayItIs) {
  const cv::Mat1f distances = river_of_10_m().distances();
  EXPECT_EQ(Corridor::at(distances, {100, 50}), 0.0);
  EXPECT_NEAR(Corridor::at(distances, {150, 50}), 45.0, 2.0);
  EXPECT_NEAR(Corridor::at(distances, {-1e6, 50}), 155.0, 3.0) << "of the raster's rim";
}

TEST(Corridor, LeavesOfALineWhatDoesNotTouchIt) {
  const auto parts = outside_of(river_of_10_m(), {{20, 50}, {50, 50}, {80, 50}, {120, 50}, {150, 50}});
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0], (Polyline{{20, 50}, {50, 50}, {80, 50}}));
  EXPECT_EQ(parts[1], (Polyline{{120, 50}, {150, 50}}));
}

}  // namespace
}  // namespace roadfix::world
