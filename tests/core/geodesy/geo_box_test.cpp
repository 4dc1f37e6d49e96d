#include "core/geodesy/geo_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace roadfix {
namespace {

/// Around many points of the sides.
GridBox walked(const UtmZone& zone, const GeoBox& box) {
  constexpr int kSteps = 4000;
  const GridPoint first = zone.project(box.south_west);
  GridBox result{first, first};
  for (int i = 0; i <= kSteps; ++i) {
    const double lat = box.south_west.lat_deg + (box.north_east.lat_deg - box.south_west.lat_deg) * i / double{kSteps};
    const double lon = box.south_west.lon_deg + (box.north_east.lon_deg - box.south_west.lon_deg) * i / double{kSteps};
    for (const LatLon at : {LatLon{lat, box.south_west.lon_deg}, LatLon{lat, box.north_east.lon_deg},
                            LatLon{box.south_west.lat_deg, lon}, LatLon{box.north_east.lat_deg, lon}}) {
      const GridPoint p = zone.project(at);
      result = united(result, {p, p});
    }
  }
  return result;
}

void expect_same(const GridBox& found, const GridBox& expected) {
  constexpr double kWalkedTooShortM = 0.01;
  EXPECT_NEAR(found.min.east_m, expected.min.east_m, kWalkedTooShortM);
  EXPECT_NEAR(found.min.north_m, expected.min.north_m, kWalkedTooShortM);
  EXPECT_NEAR(found.max.east_m, expected.max.east_m, kWalkedTooShortM);
  EXPECT_NEAR(found.max.north_m, expected.max.north_m, kWalkedTooShortM);
}

UtmZone zone_of(int epsg) { return UtmZone::from_epsg(epsg).value(); }

TEST(GridBoxAround, HoldsAllOfAWideBoxThoughItsSidesAreCurves) {
  const GridBox north{{1'000.0, 3'000'000.0}, {999'000.0, 6'000'000.0}};
  for (const GeoBox& box :
       {GeoBox{{36.0, 36.0}, {42.0, 41.3}}, GeoBox{{40.0, 36.1}, {40.5, 38.0}}, GeoBox{{40.0, 40.0}, {50.0, 41.0}}}) {
    expect_same(grid_box_around(zone_of(32637), box, north), walked(zone_of(32637), box));
  }
  const GridBox equator{{1'000.0, 9'500'000.0}, {999'000.0, 10'400'000.0}};
  const GeoBox both_hemispheres{{-3.0, 36.0}, {2.0, 42.0}};
  expect_same(grid_box_around(zone_of(32737), both_hemispheres, equator), walked(zone_of(32737), both_hemispheres));
}

TEST(GridBoxAround, HoldsABoxAtTheMiddleOfALongSideOfThePlace) {
  const UtmZone zone = zone_of(32637);
  const GridBox place{{1'000.0, 5'000'000.0}, {999'000.0, 5'100'000.0}};
  const LatLon middle = zone.unproject({500'000.0, 5'099'000.0});
  const GeoBox box{{middle.lat_deg - 0.004, middle.lon_deg - 0.01}, {middle.lat_deg + 0.004, middle.lon_deg + 0.01}};
  expect_same(grid_box_around(zone, box, place), walked(zone, box));
}

TEST(GridBoxAround, HoldsAPlaceAtTheAntimeridianWhereTheBoxEndsThereOrGoesAroundTheEarth) {
  const UtmZone fiji = zone_of(32760);
  const GridPoint meridian = fiji.project({-17.0, 180.0});
  const GridBox place = grown({meridian, meridian}, 20'000.0);
  const GridBox around_the_earth = grid_box_around(fiji, {{-18.0, -180.0}, {-16.0, 180.0}}, place);
  EXPECT_TRUE(around_the_earth.contains(place.min) && around_the_earth.contains(place.max));
  const GridBox to_the_east = grid_box_around(fiji, {{-18.0, 179.0}, {-16.0, 180.0}}, place);
  EXPECT_TRUE(to_the_east.contains(place.min));
  EXPECT_NEAR(to_the_east.max.east_m, meridian.east_m, 1000.0) << "a meridian leans on the plane";
  const GridBox from_the_west = grid_box_around(fiji, {{-18.0, -180.0}, {-16.0, -179.0}}, place);
  EXPECT_TRUE(from_the_west.contains(place.max));
  EXPECT_NEAR(from_the_west.min.east_m, meridian.east_m, 1000.0);
}

TEST(GridBoxAround, IsEmptyWhereTheBoxIsFarFromThePlaceOrThereIsNone) {
  const GridBox city{{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}};
  EXPECT_TRUE(grid_box_around(zone_of(32637), {{36.0, 100.0}, {42.0, 120.0}}, city).empty());
  EXPECT_TRUE(grid_box_around(zone_of(32637), {{-40.0, 36.0}, {-30.0, 42.0}}, city).empty());
  EXPECT_TRUE(grid_box_around(zone_of(32637), {{36.0, 36.0}, {42.0, 42.0}}, {{1.0, 1.0}, {0.0, 0.0}}).empty());
}

/// Whether the quads hold of the place what the box does. Points within `near_m` of its sides may be either.
void expect_same_ground(const UtmZone& zone, const GeoBox& box, const GridBox& place, double near_m) {
  const std::vector<GridQuad> quads = grid_quads_of(zone, box, place);
  const auto held = [&](GridPoint p, double grown_by_m) {
    return std::ranges::any_of(quads, [&](const GridQuad& quad) { return quad.grown(grown_by_m).contains(p); });
  };
  constexpr int kSteps = 200;
  int within = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const GridPoint p{place.min.east_m + place.width_m() * i / kSteps,
                        place.min.north_m + place.height_m() * j / kSteps};
      const LatLon at = zone.unproject(p);
      const double ahead_deg = at.lon_deg - box.south_west.lon_deg;
      const double east_deg = ahead_deg - 360.0 * std::floor(ahead_deg / 360.0);
      const bool in_box = at.lat_deg >= box.south_west.lat_deg && at.lat_deg <= box.north_east.lat_deg &&
                          east_deg <= box.north_east.lon_deg - box.south_west.lon_deg;
      within += in_box;
      EXPECT_TRUE(in_box ? held(p, near_m) : !held(p, -near_m)) << at.lat_deg << ", " << at.lon_deg;
    }
  }
  EXPECT_GT(within, 0);
}

TEST(GridQuadsOf, HoldWhatTheBoxDoes) {
  const GridBox town{{400'000.0, 7'190'000.0}, {412'000.0, 7'199'000.0}};  // 64.9 N, 27 E is the central meridian
  expect_same_ground(zone_of(32635), {{64.85, 24.95}, {64.9, 25.0}}, town, 0.01);
  expect_same_ground(zone_of(32635), {{10.0, 24.95}, {80.0, 24.98}}, town, 0.01);
  expect_same_ground(zone_of(32635), {{64.86, -170.0}, {64.88, 170.0}}, town, 0.01);
  const GridBox city{{610'000.0, 4'150'000.0}, {650'000.0, 4'190'000.0}};
  expect_same_ground(zone_of(32637), {{37.6, 40.3}, {37.7, 40.6}}, city, 0.1);
  const GridBox country{{200'000.0, 9'800'000.0}, {800'000.0, 10'300'000.0}};  // across the equator
  expect_same_ground(zone_of(32737), {{-1.0, 37.0}, {2.0, 41.0}}, country, 5.0);
}

TEST(GridQuadsOf, HoldWhatABoxReachesFromBothSidesAroundTheEarth) {
  const UtmZone fiji = zone_of(32760);
  const GridPoint meridian = fiji.project({-17.0, 180.0});
  const GridBox place = grown({meridian, meridian}, 20'000.0);
  expect_same_ground(fiji, {{-17.1, -179.95}, {-16.9, 179.9}}, place, 0.1);
  expect_same_ground(fiji, {{-17.1, -180.0}, {-16.9, 180.0}}, place, 0.1);
  expect_same_ground(fiji, {{-17.1, 179.9}, {-16.9, 180.1}}, place, 0.1);
}

TEST(GridQuadsOf, AreNoneWhereTheBoxIsFarFromThePlace) {
  const GridBox city{{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}};
  EXPECT_TRUE(grid_quads_of(zone_of(32637), {{36.0, 100.0}, {42.0, 120.0}}, city).empty());
  EXPECT_TRUE(grid_quads_of(zone_of(32637), {{-40.0, 36.0}, {-30.0, 42.0}}, city).empty());
}

TEST(GeoBoxAround, AcrossTheAntimeridianIsNarrow) {
  const UtmZone fiji = zone_of(32701);
  const GridPoint middle = fiji.project({-16.9, 180.0});
  const GeoBox box = geo_box_around(fiji, grown({middle, middle}, 1000.0));
  EXPECT_NEAR(box.north_east.lon_deg - box.south_west.lon_deg, 2000.0 / 106'550.0, 5e-4);
  EXPECT_GT(std::remainder(box.south_west.lon_deg, 360.0), 0.0) << "west of it lies the eastern hemisphere";
}

TEST(GeoBoxAround, AndTheGridBoxAroundThatHoldTheBox) {
  const UtmZone zone = zone_of(32637);
  const GridBox city{{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}};
  const GridBox back = grid_box_around(zone, geo_box_around(zone, city), city);
  constexpr double kCentimetre = 0.01;
  EXPECT_TRUE(grown(back, kCentimetre).contains(city.min));
  EXPECT_TRUE(grown(back, kCentimetre).contains(city.max));
  EXPECT_LT(back.width_m(), 1.01 * city.width_m() + 200.0) << "turned by the convergence, half a degree";
}

TEST(GeoBox, GoesAcrossTheAntimeridianOnlyWhereItsEastLiesMoreThanHalfATurnWestOfItsWest) {
  const std::array<double, 4> fiji{179.0, -18.0, -179.0, -16.0};
  EXPECT_EQ(told_box(fiji).value().north_east.lon_deg, 181.0);
  const std::array<double, 4> swapped{-11.0, 57.0, -12.0, 58.0};
  EXPECT_FALSE(told_box(swapped)) << "no belt round the Earth";
}

TEST(GeoBox, IsToldWithLongitudesUpTo180OrUpTo360) {
  const std::array<double, 4> across_greenwich{350.0, 45.0, 10.0, 46.0};
  EXPECT_EQ(told_box(across_greenwich).value().south_west.lon_deg, 350.0);
  EXPECT_EQ(told_box(across_greenwich).value().north_east.lon_deg, 370.0);
  const std::array<double, 4> alaska{200.0, 60.0, 220.0, 70.0};
  EXPECT_EQ(told_box(alaska).value().north_east.lon_deg, 220.0);
}

TEST(GeoBox, IsNotToldByWhatLiesBesideTheEarth) {
  for (const std::array<double, 4>& sides : {std::array{0.0, -100.0, 10.0, 1.0}, std::array{0.0, 0.0, 10.0, 91.0},
                                             std::array{-361.0, 0.0, 1.0, 1.0}, std::array{0.0, 0.0, 361.0, 1.0}}) {
    EXPECT_FALSE(told_box(sides)) << sides[0] << ' ' << sides[1] << ' ' << sides[2] << ' ' << sides[3];
  }
}

TEST(GeoBox, IsEmptyWhereACornerIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE((GeoBox{{0.0, 179.0}, {1.0, 181.0}}.empty()));
  EXPECT_TRUE((GeoBox{{0.0, 0.0}, {1.0, 0.0}}.empty()));
  EXPECT_TRUE((GeoBox{{nan, 0.0}, {1.0, 1.0}}.empty()));
}

}  // namespace
}  // namespace roadfix
