#include "core/survey/localizability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "tests/support/code_of.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::view_of;

GridGeometry square(int cells) { return {2.0, {300'000, -3'200'000}, cells, cells}; }

LocalizabilityQuery centre_of(const MapView& view, double footprint_m) {
  LocalizabilityQuery query;
  query.position = view.zone.unproject(view.extent.centre());
  query.footprint_m = footprint_m;
  query.radius_m = 500.0;
  return query;
}

TEST(Localizability, IsHighWhereStreetsWind) {
  const MapView view = view_of(testing::street_map(22, square(800)));
  const Localizability place = localizability(view, centre_of(view, 400.0));
  EXPECT_EQ(place.status, FixStatus::kFix) << place.reason;
  EXPECT_GT(place.probability, 0.99);
  EXPECT_GT(place.road_share, 0.01);
  EXPECT_EQ(place.observed_share, 1.0);
}

TEST(Localizability, GrowsWithTheFootprint) {
  const MapView view = view_of(testing::street_map(21, square(800)));
  EXPECT_LT(localizability(view, centre_of(view, 60.0)).probability,
            localizability(view, centre_of(view, 400.0)).probability);
}

TEST(Localizability, IsLowInACityOfEqualBlocksAndNamesPlacesAlike) {
  const MapView view = view_of(testing::grid_city(square(800), 90.0));
  const Localizability place = localizability(view, centre_of(view, 300.0));
  EXPECT_NE(place.status, FixStatus::kFix);
  EXPECT_LT(place.probability, 0.5);
  EXPECT_FALSE(place.alike.empty());
}

TEST(Localizability, IsNoneAtACrossingAlone) {
  constexpr int kCells = 800;
  RoadGrid country{square(kCells), CellArray(kCells, kCells, kNoRoad)};
  for (int i = 0; i < kCells; ++i) {
    for (int width = 0; width < 4; ++width) {
      country.cells.at(398 + width, i) = kRoad;
      country.cells.at(i, std::clamp(248 + 3 * i / 8 + width, 0, kCells - 1)) = kRoad;
    }
  }
  const MapView view = view_of(country);
  const Localizability place = localizability(view, centre_of(view, 400.0));
  EXPECT_EQ(place.status, FixStatus::kNoFix);
  EXPECT_FALSE(place.bare);
  EXPECT_EQ(place.reason, "not-above-chance") << "another crossing looks like it";
  EXPECT_LE(place.probability, 0.5);
}

TEST(Localizability, SaysInWordsThatAFrameFitsBetterElsewhere) {
  const MapView view = view_of(testing::grid_city(square(800), 90.0));
  int elsewhere = 0;
  for (int i = 0; i < 2; ++i) {
    LocalizabilityQuery query = centre_of(view, 200.0);
    const GridPoint centre = view.extent.centre();
    query.position = view.zone.unproject({centre.east_m + 37.0 * i, centre.north_m});
    const Localizability place = localizability(view, query);
    ASSERT_NE(place.status, FixStatus::kFix);
    if (place.reason != "wrong-place") continue;
    ++elsewhere;
    EXPECT_EQ(place.probability, 0.0);
    EXPECT_NE(place.explanation.find("elsewhere"), std::string::npos) << place.explanation;
  }
  EXPECT_GT(elsewhere, 0);
}

TEST(Localizability, TellsABarePlaceAlsoWhereItsPieceOfRoadFitsBetterElsewhere) {
  constexpr int kCells = 800;
  RoadGrid country{square(kCells), CellArray(kCells, kCells, kNoRoad)};
  for (int piece = 0; piece < 16; ++piece) {  // of 120 m, in each square of 400 m
    for (int along = 0; along < 60; ++along) {
      for (int width = 0; width < 3; ++width) {
        const int across = along * (piece - 8) / 8;
        country.cells.at(200 * (piece % 4) + 70 + along, 200 * (piece / 4) + 100 + across + width) = kRoad;
      }
    }
  }
  const MapView view = view_of(country);
  LocalizabilityQuery query = centre_of(view, 400.0);
  int elsewhere = 0;
  for (const double east_m : {-200.0, 200.0}) {
    for (const double north_m : {-200.0, 200.0}) {
      const GridPoint centre = view.extent.centre();
      query.position = view.zone.unproject({centre.east_m + east_m, centre.north_m + north_m});
      const Localizability place = localizability(view, query);
      EXPECT_TRUE(place.bare);
      elsewhere += place.reason == "wrong-place" ? 1 : 0;
    }
  }
  EXPECT_GT(elsewhere, 0);
}

TEST(Localizability, SaysWhyABareOrUnobservedPlaceGivesNoFix) {
  RoadGrid bare{square(400), CellArray(400, 400, kNoRoad)};
  const MapView view = view_of(bare);
  EXPECT_EQ(localizability(view, centre_of(view, 200.0)).reason, "too-few-roads");
  EXPECT_TRUE(localizability(view, centre_of(view, 200.0)).bare);
  RoadGrid unseen{square(400), CellArray(400, 400)};
  const MapView nothing = view_of(unseen);
  const Localizability place = localizability(nothing, centre_of(nothing, 200.0));
  EXPECT_EQ(place.reason, "footprint-unobserved");
  EXPECT_FALSE(place.explanation.empty());
  EXPECT_EQ(place.observed_share, 0.0);
}

TEST(Localizability, LooksAtLargeFootprintsInCoarserCellsThanThoseOfAFineMap) {
  MapView view = view_of({{0.25, {2'400'000, -25'600'000}, 1, 1}, CellArray(1, 1)});
  std::int64_t max_cells = 0;
  view.read = [&](const GridGeometry& geometry) {
    max_cells = std::max(max_cells, std::int64_t{geometry.cols} * geometry.rows);
    return RoadGrid{geometry, CellArray(1, 1)};  // beyond its cells it is unobserved, too
  };
  EXPECT_EQ(localizability(view, centre_of(view, 5000.0)).reason, "footprint-unobserved");
  EXPECT_LE(max_cells, 8192 * 8192 + 1);
}

TEST(Localizability, OfAPlaceOutsideTheMapIsRefusedWithoutAWordOfPriors) {
  const MapView view = view_of(testing::street_map(21, square(200)));
  LocalizabilityQuery far = centre_of(view, 200.0);
  far.position.lon_deg += 0.1;
  EXPECT_EQ(testing::code_of([&] { localizability(view, far); }), "prior-outside-map");
  EXPECT_EQ(testing::message_of([&] { localizability(view, far); }).find("the place lies outside the map"), 0U);
}

TEST(Localizability, RefusesAFootprintOfNoSize) {
  const MapView view = view_of(testing::street_map(21, square(200)));
  EXPECT_EQ(testing::code_of([&] { localizability(view, centre_of(view, 0.0)); }), "parameter-out-of-range");
}

}  // namespace
}  // namespace roadfix
