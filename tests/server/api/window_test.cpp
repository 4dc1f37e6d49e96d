#include "server/api/window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units/error.hpp"
#include "tests/support/ascii_map.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::api {
namespace {

using roadfix::testing::from_ascii;
using roadfix::testing::to_ascii;

/// A map of the picture's cells, 2 m each, with its north-western corner at (434000, 4180000) of zone 37 N.
MapView view_of_picture(const std::string& picture) {
  const CellArray cells = from_ascii(picture);
  const GridGeometry geometry{2.0, {217000, -2090000}, cells.cols(), cells.rows()};
  const RoadGrid whole{geometry, cells};
  const auto read = [whole](const GridGeometry& asked) {
    RoadGrid part = RoadGrid::unobserved(asked);
    paste(whole.cells, part.cells, whole.geometry.origin.col - asked.origin.col,
          whole.geometry.origin.row - asked.origin.row);
    return part;
  };
  return {{"city", "v1"}, *UtmZone::from_epsg(32637), 2.0, geometry.box(), {}, {}, read};
}

constexpr const char* kPicture = R"(
  #.........
  .#......#.
  ..#...##..
  ...###....
  ..........
  ?????.....)";

LatLon at(double east_m, double north_m) { return UtmZone::from_epsg(32637)->unproject({east_m, north_m}); }

TEST(Window, AlongTheGridGivesTheMapsOwnCellsAndTheNearestSuchCentre) {
  const MapView map = view_of_picture(kPicture);
  const Window window = cut_window(map, {at(434010.3, 4179994.2), std::nullopt, 20.0, 12.0, std::nullopt}, {});
  EXPECT_EQ(to_ascii(window.cells.cells), to_ascii(from_ascii(kPicture)));
  EXPECT_NEAR(window.grid_pose.position.east_m, 434010.0, 1e-6);
  EXPECT_NEAR(window.grid_pose.position.north_m, 4179994.0, 1e-6);
}

TEST(Window, ReadsNoMoreOfTheMapThanALongWindowOnASlantMeets) {
  MapView map = view_of_picture(kPicture);
  const auto read = [&](const GridBox& extent, double width_m) {
    double max_cells = 0.0;
    map.extent = extent;
    map.read = [&](const GridGeometry& asked) {
      max_cells = std::max(max_cells, double{1} * asked.cols * asked.rows);
      return RoadGrid{asked, CellArray(1, 1)};  // beyond its cells it is unobserved, too
    };
    cut_window(map, {at(434010.0, 4179994.0), Angle::degrees(45.0), width_m, 2.0, std::nullopt}, {});
    return max_cells;
  };
  EXPECT_LT(read(map.extent, 100'000.0), 200.0);
  EXPECT_EQ(roadfix::testing::code_of([&] { read(grown(map.extent, 100'000.0), 100'000.0); }), "too-many-cells");
  EXPECT_GT(read(grown(map.extent, 10'000.0), 10'000.0), 1e7);
}

TEST(Window, HasATransformThatPutsItsCornersOnTheGroundTheyShow) {
  const MapView map = view_of_picture(kPicture);
  const GridPoint centre{434010.0, 4179994.0};
  const Angle heading = map.zone.true_from_grid(Angle::degrees(90.0), centre);
  const Window east = cut_window(map, {at(centre.east_m, centre.north_m), heading, 12.0, 20.0, std::nullopt}, {});
  // Heading grid east: the forward edge is the map's eastern column, columns run south.
  EXPECT_EQ(east.cells.cells.at(5, 9), kUnobserved) << "the south-western corner of the map is behind and to the right";
  EXPECT_EQ(east.cells.cells.at(0, 9), kRoad) << "the north-western corner is behind and to the left";
  const auto t = geotransform(east);
  EXPECT_NEAR(t[0], 434020.0, 1e-3);
  EXPECT_NEAR(t[3], 4180000.0, 1e-3);
  EXPECT_NEAR(t[1], 0.0, 1e-6);
  EXPECT_NEAR(t[2], -2.0, 1e-6);
  EXPECT_NEAR(t[4], -2.0, 1e-6);
  EXPECT_NEAR(t[5], 0.0, 1e-6);
}

TEST(Window, IsUnobservedWhereTheMapEndsAndRefusedOutsideIt) {
  const MapView map = view_of_picture(kPicture);
  const Window window = cut_window(map, {at(434000.0, 4180000.0), std::nullopt, 40.0, 40.0, std::nullopt}, {});
  EXPECT_EQ(window.cells.cells.at(0, 0), kUnobserved);
  EXPECT_EQ(window.cells.cells.at(10, 10), kRoad);
  EXPECT_THROW(cut_window(map, {at(500000.0, 4180000.0), std::nullopt, 40.0, 40.0, std::nullopt}, {}), InvalidInput);
}

TEST(Window, RefusesMoreCellsThanTheLimitWithoutMakingThem) {
  Limits limits;
  limits.cells = 100;
  EXPECT_THROW(cut_window(view_of_picture(kPicture), {at(434010.0, 4179994.0), std::nullopt, 1e6, 1e6, 0.001}, limits),
               LimitExceeded);
}

TEST(Window, TellsItsGroundInJson) {
  const auto described = to_json(
      cut_window(view_of_picture(kPicture), {at(434010.0, 4179994.0), std::nullopt, 20.0, 12.0, std::nullopt}, {}));
  EXPECT_EQ(described["cols"], 10);
  EXPECT_EQ(described["rows"], 6);
  EXPECT_EQ(described["footprint"]["coordinates"][0].size(), 5U);
  EXPECT_EQ(described["footprint"]["coordinates"][0][0], described["footprint"]["coordinates"][0][4]);
  EXPECT_EQ(described["map"]["version"], "v1");
}

TEST(Window, HasAFootprintOfTwoPartsOnBothSidesOf180Degrees) {
  Window window =
      cut_window(view_of_picture(kPicture), {at(434010.0, 4179994.0), std::nullopt, 20.0, 12.0, std::nullopt}, {});
  window.zone = *UtmZone::from_epsg(32760);
  window.grid_pose.position = window.zone.project({-17.0, 180.0});
  const auto footprint = to_json(window)["footprint"];
  EXPECT_EQ(footprint["type"], "MultiPolygon");
  EXPECT_EQ(footprint["coordinates"].size(), 2U);
}

}  // namespace
}  // namespace roadfix::api
