#include "core/geodesy/utm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

// GeographicLib, "geoconvert -u" of its manual page: 33.3 N 44.4 E = 38n 444140.54 3684706.36.
TEST(UtmZone, ProjectsThePublishedExample) {
  const LatLon baghdad{33.3, 44.4};
  const UtmZone zone = UtmZone::containing(baghdad);
  EXPECT_EQ(zone.epsg(), 32638);
  const GridPoint p = zone.project(baghdad);
  EXPECT_NEAR(p.east_m, 444140.54, 0.005);
  EXPECT_NEAR(p.north_m, 3684706.36, 0.005);
}

TEST(UtmZone, ComesBackFromThePlane) {
  const LatLon cape{-34.0, 20.5};
  const UtmZone zone = UtmZone::containing(cape);
  EXPECT_FALSE(zone.northern());
  const LatLon back = zone.unproject(zone.project(cape));
  EXPECT_NEAR(back.lat_deg, cape.lat_deg, 1e-12);
  EXPECT_NEAR(back.lon_deg, cape.lon_deg, 1e-12);
}

TEST(UtmZone, KeepsOneNorthingAcrossTheEquator) {
  const UtmZone zone = UtmZone::containing({0.001, 39.0});
  EXPECT_LT(zone.project({-0.001, 39.0}).north_m, 0.0);
}

// East of the central meridian on the northern hemisphere grid north lies east of true north: sin(lat) * dlon.
TEST(UtmZone, ConvergenceIsTrueMinusGridHeading) {
  const LatLon adiyaman{37.76, 38.28};
  const UtmZone zone = UtmZone::containing(adiyaman);
  const GridPoint p = zone.project(adiyaman);
  EXPECT_NEAR(zone.convergence(p).degrees(), (38.28 - 39.0) * 0.6124, 0.001);
  const LatLon north_of_it{37.77, 38.28};
  const GridPoint q = zone.project(north_of_it);
  const Angle grid_bearing_of_true_north = Angle::radians(std::atan2(q.east_m - p.east_m, q.north_m - p.north_m));
  EXPECT_NEAR(zone.grid_from_true(Angle::degrees(0), p).degrees(), grid_bearing_of_true_north.degrees(), 0.001);
}

TEST(UtmZone, RefusesPolesAndNonsense) {
  const auto refusal_of = [](LatLon point) { return testing::code_of([&] { UtmZone::containing(point); }); };
  for (const double pole : {89.0, -81.0}) EXPECT_EQ(refusal_of({pole, 0.0}), "position-in-polar-region") << pole;
  EXPECT_EQ(refusal_of({std::numeric_limits<double>::quiet_NaN(), 0.0}), "parameter-out-of-range");
  EXPECT_EQ(refusal_of({91.0, 0.0}), "parameter-out-of-range");
  const UtmZone zone = UtmZone::containing({40.0, 39.0});
  EXPECT_EQ(testing::code_of([&] { zone.project({40.0, -140.0}); }), "position-outside-zone");
  EXPECT_FALSE(zone.project_if_defined({40.0, -140.0}));
}

TEST(UtmZone, KnowsItsEpsgCodesOnly) {
  EXPECT_EQ(UtmZone::from_epsg(32733)->epsg(), 32733);
  EXPECT_FALSE(UtmZone::from_epsg(4326));
  EXPECT_FALSE(UtmZone::from_epsg(32661));
  EXPECT_FALSE(UtmZone::from_epsg(32700));
}

}  // namespace
}  // namespace roadfix
