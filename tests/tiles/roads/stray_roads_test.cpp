#include "tiles/roads/stray_roads.hpp"

#include <gmock/gmock.h>

#include "tests/tiles/roads/road_features.hpp"

namespace roadfix {
namespace {

using testing::at;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kZone;

class StrayRoads : public testing::RoadFeatures {
 protected:
  /// `side` x `side` roads, one every `apart_m`, north-east of the centre.
  static std::vector<std::string> town(int side, double apart_m) {
    std::vector<std::string> roads;
    for (int row = 0; row < side; ++row) {
      for (int col = 0; col < side; ++col) roads.push_back(road(col * apart_m, row * apart_m));
    }
    return roads;
  }
};

TEST_F(StrayRoads, AreToldWithTheExtentThatLeavesThemOut) {
  auto roads = town(10, 200);
  roads.push_back(road(40'000, 30'000));
  const auto told = notes(roads);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told.front(),
              HasSubstr("roads.geojson: 100 of its 101 roads lie within 1.9 x 1.9 km, but 40.1 x 30.9 km"));
  const std::size_t start = told.front().find("--extent ") + 9;
  const std::string extent = told.front().substr(start, told.front().find(' ', start) - start);
  EXPECT_THAT(notes(roads, extent), IsEmpty());
  const auto covered =
      read_road_network({geojson(roads)}, {.crs = "", .layer = "", .extent = extent}, RoadRules(), kZone).covered;
  ASSERT_EQ(covered.size(), 1U);
  EXPECT_TRUE(covered.front().box().contains(at(0, 0)));
  EXPECT_TRUE(covered.front().box().contains(at(1900, 1900)));
  EXPECT_LT(covered.front().box().width_m(), 2000.0);
}

TEST_F(StrayRoads, MayLieTogetherAndOnAllSides) {
  auto roads = town(10, 200);
  for (const double east : {40'000.0, 40'300.0, -20'000.0}) roads.push_back(road(east, east / 2));
  EXPECT_THAT(notes(roads), ElementsAre(HasSubstr("100 of its 103 roads lie within 1.9 x 1.9 km")));
}

TEST_F(StrayRoads, AreToldOfWhereTheyLeadToAZoneFarFromTheMany) {
  auto roads = town(10, 200);
  roads.emplace_back(R"({"type":"Feature","properties":{"highway":"residential"},)"
                     R"("geometry":{"type":"LineString","coordinates":[[0,0],[0.001,0.001]]}})");
  const UtmZone between = *UtmZone::from_epsg(32634);  // that of the middle of the box
  const RoadNetwork network = read_road_network({geojson(roads)}, {}, RoadRules(), between);
  EXPECT_THAT(network.notes, ElementsAre(HasSubstr("--extent 37.8")));
}

TEST_F(StrayRoads, AreNoVillagesAroundATown) {
  auto roads = town(10, 200);
  for (int i = 0; i < 12; ++i) roads.push_back(road(-8'000 + 1'500 * i, 9'000));
  EXPECT_THAT(notes(roads), IsEmpty());
}

TEST_F(StrayRoads, AreNotToldOfWhereLittleGroundIsAddedOrFewRoadsTell) {
  auto roads = town(10, 20);
  roads.push_back(road(2'000, 2'000));
  EXPECT_THAT(notes(roads), IsEmpty()) << "4 km2";
  roads = town(3, 200);
  roads.push_back(road(40'000, 30'000));
  EXPECT_THAT(notes(roads), IsEmpty()) << "10 roads";
}

}  // namespace
}  // namespace roadfix
