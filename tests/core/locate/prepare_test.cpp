#include "core/locate/prepare.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

MapView map_of(int epsg, const GridBox& extent) {
  return {"country", "1", UtmZone::from_epsg(epsg).value(), 16.0, extent, 0.0, {}};
}

GridBox region(const MapView& map, const GeoBox& box) {
  Prior prior;
  prior.box = box;
  return region_of(map, prior).box;
}

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

TEST(RegionOf, HoldsAllOfAWideBoxThoughItsSidesAreCurves) {
  const MapView north = map_of(32637, {{1'000.0, 3'000'000.0}, {999'000.0, 6'000'000.0}});
  for (const GeoBox& box :
       {GeoBox{{36.0, 36.0}, {42.0, 41.3}}, GeoBox{{40.0, 36.1}, {40.5, 38.0}}, GeoBox{{40.0, 40.0}, {50.0, 41.0}}}) {
    expect_same(region(north, box), walked(north.zone, box));
  }
  const MapView equator = map_of(32737, {{1'000.0, 9'500'000.0}, {999'000.0, 10'400'000.0}});
  const GeoBox both_hemispheres{{-3.0, 36.0}, {2.0, 42.0}};
  expect_same(region(equator, both_hemispheres), walked(equator.zone, both_hemispheres));
}

TEST(RegionOf, TakesABoxThatReachesFarBeyondTheZone) {
  const GridBox city{{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}};
  const MapView map = map_of(32637, city);
  for (const GeoBox& box : {GeoBox{{36.0, 26.0}, {42.0, 45.0}}, GeoBox{{-90.0, -180.0}, {90.0, 180.0}},
                            GeoBox{{30.0, 10.0}, {40.0, 179.0}}}) {
    expect_same(region(map, box), city);
  }
  for (const GeoBox& box : {GeoBox{{36.0, 100.0}, {42.0, 120.0}}, GeoBox{{36.0, -140.0}, {42.0, 30.0}},
                            GeoBox{{-40.0, 36.0}, {-30.0, 42.0}}}) {
    EXPECT_EQ(testing::code_of([&] { region(map, box); }), "prior-outside-map");
  }
}

TEST(RegionOf, TakesBoxesOnEitherSideOfTheAntimeridian) {
  const MapView map = map_of(32701, {{150'000.0, 8'000'000.0}, {250'000.0, 8'010'000.0}});  // Fiji, 179.7 E to 179.4 W
  const double antimeridian_m = map.zone.project({-18.0, 180.0}).east_m;
  EXPECT_LT(region(map, {{-19.0, 179.0}, {-17.0, 180.0}}).max.east_m, antimeridian_m + 1000.0);
  EXPECT_GT(region(map, {{-19.0, -180.0}, {-17.0, -179.0}}).min.east_m, antimeridian_m - 1000.0);
}

}  // namespace
}  // namespace roadfix
