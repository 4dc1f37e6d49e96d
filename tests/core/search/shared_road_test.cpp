#include "core/search/shared_road.hpp"

#include <gtest/gtest.h>

#include "tests/support/ascii_map.hpp"

namespace roadfix {
namespace {

using testing::from_ascii;

TEST(SharedRoad, IsTheRoadThatMapAndFeaturesHaveInCommon) {
  const CellArray map = from_ascii(R"(
    ..........
    .######...
    ..........
    ..........
    ..........)");
  const CellArray features = from_ascii(R"(
    ..........
    ....######
    ..........
    .#........
    .#........)");
  EXPECT_NEAR(shared_road_cells(map, features), 3.0, 1e-9);
}

TEST(SharedRoad, DoesNotDependOnHowSureADetectorIs) {
  const CellArray map = from_ascii(R"(
    ........
    .######.
    ........)");
  const CellArray faint = from_ascii(R"(
    11111111
    13333331
    11111111)");
  EXPECT_NEAR(shared_road_cells(map, map), 6.0, 1e-9);
  EXPECT_NEAR(shared_road_cells(map, faint), 6.0, 1e-9);
}

TEST(SharedRoad, OfRoadsThatDoNotMeetIsNothing) {
  EXPECT_EQ(shared_road_cells(from_ascii("#...."), from_ascii("...#.")), 0.0);
  EXPECT_EQ(shared_road_cells(from_ascii("....."), from_ascii("...#.")), 0.0);
}

TEST(SharedRoad, LeavesOutWhatWasNotObservedInBoth) {
  EXPECT_NEAR(shared_road_cells(from_ascii("##??...."), from_ascii("?###....")), 1.0, 1e-9);
  EXPECT_EQ(shared_road_cells(from_ascii("????"), from_ascii("##..")), 0.0);
}

}  // namespace
}  // namespace roadfix
