#include "core/geodesy/shown_ground.hpp"

#include <gmock/gmock.h>

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ShownGround : public ::testing::Test {
 protected:
  /// One kilometre on each side of 37.76 N, 38.27 E.
  std::string beside(const GeoBox& asked, double within_m) const {
    const GridPoint middle = zone_.project({37.76, 38.27});
    return shown_ground_beside(asked, within_m, zone_, grown({middle, middle}, 1000.0));
  }

  const UtmZone zone_ = UtmZone::from_epsg(32637).value();
};

TEST_F(ShownGround, IsToldInDegrees) {
  EXPECT_EQ(beside({{50.0, 21.0}, {50.0, 21.0}}, 100.0),
            "which shows latitude 37.7509 to 37.7691 and longitude 38.2586 to 38.2814");
}

TEST_F(ShownGround, HasLatitudeAndLongitudeSwappedOnlyWhereThePlaceWouldThenMeetIt) {
  const auto swapped = HasSubstr("; latitude and longitude may be swapped");
  EXPECT_THAT(beside({{38.27, 37.76}, {38.27, 37.76}}, 100.0), swapped);
  EXPECT_THAT(beside({{38.30, 37.76}, {38.30, 37.76}}, 2000.0), swapped);
  EXPECT_THAT(beside({{38.26, 37.75}, {38.29, 37.78}}, 0.0), swapped);
  EXPECT_THAT(beside({{38.30, 37.76}, {38.30, 37.76}}, 100.0), Not(swapped));
  EXPECT_THAT(beside({{37.90, 38.275}, {37.90, 38.275}}, 500.0), Not(swapped));
  EXPECT_THAT(beside({{50.0, 21.0}, {50.0, 21.0}}, 1e8), Not(swapped));
  EXPECT_THAT(beside({{-38.27, -122.0}, {-38.27, -122.0}}, 100.0), Not(swapped));
}

}  // namespace
}  // namespace roadfix
