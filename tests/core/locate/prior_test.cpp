#include "core/locate/prior.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

MapView map_of(int epsg, const GridBox& extent) {
  return {{"country", "1"}, UtmZone::from_epsg(epsg).value(), 16.0, extent, {}, {}, {}};
}

GridBox region(const MapView& map, const GeoBox& box) {
  Prior prior;
  prior.box = box;
  return region_of(map, prior).box;
}

TEST(RegionOf, TakesABoxThatReachesFarBeyondTheZone) {
  const GridBox city{{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}};
  const MapView map = map_of(32637, city);
  for (const GeoBox& box : {GeoBox{{36.0, 26.0}, {42.0, 45.0}}, GeoBox{{-90.0, -180.0}, {90.0, 180.0}},
                            GeoBox{{30.0, 10.0}, {40.0, 179.0}}}) {
    const GridBox found = region(map, box);
    EXPECT_EQ(found.min, city.min);
    EXPECT_EQ(found.max, city.max);
  }
  for (const GeoBox& box : {GeoBox{{36.0, 100.0}, {42.0, 120.0}}, GeoBox{{36.0, -140.0}, {42.0, 30.0}},
                            GeoBox{{-40.0, 36.0}, {-30.0, 42.0}}}) {
    EXPECT_EQ(testing::code_of([&] { region(map, box); }), "prior-outside-map");
  }
}

TEST(RegionOf, IsWhatCircleAndBoxHaveInCommon) {
  const MapView map = map_of(32637, {{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}});
  const LatLon middle = map.zone.unproject({435'000.0, 4'175'000.0});
  Prior prior;
  prior.circle = GeoCircle{middle, 1000.0};
  prior.box = GeoBox{middle, {42.0, 45.0}};
  const PoseRegion region = region_of(map, prior);
  EXPECT_NEAR(region.box.min.east_m, 435'000.0, 100.0);  // true north is half a degree off the grid's
  EXPECT_NEAR(region.box.min.north_m, 4'175'000.0, 100.0);
  EXPECT_DOUBLE_EQ(region.box.max.east_m, 436'000.0);
  EXPECT_TRUE(region.circle);
  prior.circle->radius_m = 100.0;
  prior.box = GeoBox{map.zone.unproject({436'000.0, 4'176'000.0}), {42.0, 45.0}};
  EXPECT_EQ(testing::code_of([&] { region_of(map, prior); }), "prior-contradictory") << "each of them is on the map";
}

TEST(RegionOf, SaysWhereTheMapLiesOfAPriorOutsideOfIt) {
  const MapView map = map_of(32637, {{430'000.0, 4'170'000.0}, {440'000.0, 4'180'000.0}});
  const LatLon middle = map.zone.unproject({435'000.0, 4'175'000.0});
  const LatLon swapped{middle.lon_deg, middle.lat_deg};
  Prior circle;
  circle.circle = GeoCircle{swapped, 100.0};
  Prior box;
  box.box = GeoBox{swapped, {swapped.lat_deg + 0.1, swapped.lon_deg + 0.1}};
  for (const Prior& prior : {circle, box}) {
    EXPECT_THAT(testing::message_of([&] { region_of(map, prior); }),
                ::testing::HasSubstr("outside the map country, which shows latitude 37.67"));
    EXPECT_THAT(testing::message_of([&] { region_of(map, prior); }), ::testing::HasSubstr("may be swapped"));
  }
}

MapView far_north() {  // where grid north is 2.6 degrees off
  const UtmZone zone = UtmZone::from_epsg(32635).value();
  const GridPoint middle = zone.project({64.9, 29.9});
  return map_of(32635, grown({middle, middle}, 20'000.0));
}

TEST(RegionOf, HoldsNothingBeyondTheSidesOfABox) {
  const MapView map = far_north();
  Prior prior;
  prior.box = GeoBox{{64.7, 29.8}, {65.1, 29.895}};
  const PoseRegion region = region_of(map, prior);
  for (const double lat_deg : {64.8, 64.9, 65.0}) {
    for (const auto& [lon_deg, within] : {std::pair{29.799, false}, {29.801, true}, {29.894, true}, {29.896, false}}) {
      EXPECT_EQ(region.contains(map.zone.project({lat_deg, lon_deg})), within) << lat_deg << ", " << lon_deg;
    }
  }
  const double told_km2 = 40.0 * 0.095 * 111.3 * std::cos(64.9 * std::numbers::pi / 180.0);  // as high as the map
  EXPECT_NEAR(region.area_km2(), told_km2, 0.05 * told_km2);
}

TEST(RegionOf, IsNoBoxBesideTheMapWhoseCornersReachOverIt) {
  const MapView map = far_north();
  const LatLon east = map.zone.unproject({map.extent.max.east_m, map.extent.centre().north_m});
  Prior prior;
  prior.box = GeoBox{{64.0, east.lon_deg + 0.03}, {65.8, east.lon_deg + 0.04}};  // 1.4 km from it
  EXPECT_EQ(testing::code_of([&] { region_of(map, prior); }), "prior-outside-map");
}

TEST(RegionOf, HasTheHeadingsThatAreToldWhereverInItTheyAre) {
  const MapView map = map_of(32635, {{600'000.0, 7'190'000.0}, {660'000.0, 7'210'000.0}});
  Prior prior;
  prior.heading = HeadingRange{Angle::degrees(33.0), Angle::degrees(0.2)};
  const PoseRegion region = region_of(map, prior);
  for (const GridPoint at : {map.extent.min, map.extent.centre(), map.extent.max}) {
    for (const double told_deg : {32.81, 33.19}) {
      EXPECT_TRUE(region.contains(map.zone.grid_from_true(Angle::degrees(told_deg), at))) << told_deg;
    }
  }
  EXPECT_LT(region.heading_half_width, Angle::degrees(1.0));
  prior.circle = GeoCircle{map.zone.unproject(map.extent.max), 500.0};
  EXPECT_LT(region_of(map, prior).heading_half_width, Angle::degrees(0.21)) << "in a small region";
  prior.heading->half_width = Angle::degrees(180.0);
  EXPECT_EQ(region_of(map, prior).heading_half_width, Angle::degrees(180.0));
}

TEST(RegionOf, TakesBoxesOnEitherSideOfTheAntimeridian) {
  const MapView map = map_of(32701, {{150'000.0, 8'000'000.0}, {250'000.0, 8'010'000.0}});  // Fiji, 179.7 E to 179.4 W
  const double antimeridian_m = map.zone.project({-18.0, 180.0}).east_m;
  EXPECT_LT(region(map, {{-19.0, 179.0}, {-17.0, 180.0}}).max.east_m, antimeridian_m + 1000.0);
  EXPECT_GT(region(map, {{-19.0, -180.0}, {-17.0, -179.0}}).min.east_m, antimeridian_m - 1000.0);
}

}  // namespace
}  // namespace roadfix
