#include "tiles/roads/bare_rim.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "tests/tiles/roads/road_features.hpp"

namespace roadfix {
namespace {

using testing::at;
using ::testing::ElementsAre;
using testing::feature;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BareRim : public testing::RoadFeatures {
 protected:
  /// Roads every 500 m of a square of 16 km, where the country is.
  static std::vector<std::string> extract(const std::function<bool(double east, double north)>& country) {
    std::vector<std::string> roads;
    for (double north = 200; north < 16'000; north += 500) {
      for (double east = 200; east < 16'000; east += 500) {
        if (country(east, north)) roads.push_back(road(east, north));
      }
    }
    return roads;
  }
};

TEST_F(BareRim, OfACountryBetweenSlantedBordersIsToldOf) {
  const auto slanted = extract([](double east, double north) { return std::abs(east - north) < 6'000; });
  EXPECT_THAT(notes(slanted), ElementsAre(HasSubstr("--extent FILE.poly or .geojson")));
  EXPECT_THAT(notes(slanted, testing::extent_around_centre(9'000)), IsEmpty()) << "the user has said what is covered";
}

TEST_F(BareRim, IsThatOfNoRectangleWithRoadsThatCrossItsRimAndALakeInside) {
  auto town = extract([](double east, double north) { return std::hypot(east - 8'000, north - 8'000) > 5'000; });
  EXPECT_THAT(notes(town), IsEmpty());
  for (const double along : {2'000.0, 6'000.0, 13'000.0}) {
    town.push_back(feature(R"("highway":"primary")", at(-4'000, along), at(500, along)));
    town.push_back(feature(R"("highway":"primary")", at(along, 15'000), at(along, 20'000)));
  }
  EXPECT_THAT(notes(town), IsEmpty());
}

TEST_F(BareRim, IsNotJudgedByAFewRoads) {
  auto roads = extract([](double east, double north) { return std::abs(east - north) < 6'000; });
  roads.resize(199);
  EXPECT_THAT(notes(roads), IsEmpty());
}

}  // namespace
}  // namespace roadfix
