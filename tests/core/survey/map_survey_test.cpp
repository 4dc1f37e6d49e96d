#include "core/survey/map_survey.hpp"

#include <gtest/gtest.h>

#include <stop_token>

#include "core/grid/resample.hpp"
#include "tests/core/survey/town_and_fields.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using testing::counted;
using testing::query_of_a_third;
using testing::town_fields_and_unknown_ground;
using testing::view_of;

SurveyOptions options() {
  SurveyOptions options;
  options.query = query_of_a_third();
  return options;
}

TEST(MapSurvey, TellsGroundThatGivesAFixFromBareAndUnknownGround) {
  const MapView map = town_fields_and_unknown_ground();
  SurveyOptions all = options();
  all.threads = 2;
  std::int64_t told = 0;
  all.progress = counted(told, 4);
  const MapSurvey found = survey(map, all);
  EXPECT_EQ(told, 4);
  EXPECT_EQ(found.distinct, 2);
  EXPECT_EQ(found.sparse, 0);
  EXPECT_EQ(found.bare, 2);
  EXPECT_NEAR(found.ground_m2, 800.0 * 800.0, 1.0);
}

TEST(MapSurvey, CallsGroundSparseWhoseRoadsFitElsewhere) {
  SurveyOptions of_city = options();
  of_city.query.footprint_m = 300.0;
  const MapSurvey found = survey(view_of(testing::grid_city({2.0, {300'000, -3'200'000}, 600, 600}, 90.0)), of_city);
  EXPECT_EQ(found.distinct, 0);
  EXPECT_GT(found.sparse, 0);
  EXPECT_EQ(found.bare, 0);
}

TEST(MapSurvey, AsksAtFewerPlacesThatStandForMoreGroundWhereItWouldBeTooMany) {
  SurveyOptions few = options();
  few.max_places = 2;
  const MapSurvey found = survey(town_fields_and_unknown_ground(), few);
  EXPECT_EQ(found.distinct, 1);
  EXPECT_EQ(found.bare, 1);
  EXPECT_NEAR(found.ground_m2, 800.0 * 800.0, 1.0);
}

/// A town and, 8 km from it, fields; each of 800 x 800 m.
MapView town_and_far_fields() {
  constexpr int kCells = 400;
  RoadGrid ground = RoadGrid::unobserved({2.0, {300'000, -3'200'000}, 4000 + kCells, 4000 + kCells});
  paste(testing::street_map(22, {2.0, {}, kCells, kCells}).cells, ground.cells, 0, 4000);
  paste(CellArray(kCells, kCells, kNoRoad), ground.cells, 4000, 0);
  return view_of(ground);
}

TEST(MapSurvey, AsksAtObservedGroundOnlyHoweverFarApartItLies) {
  const MapView map = town_and_far_fields();
  for (const std::int64_t places : {8, 4, 2}) {
    SurveyOptions few = options();
    few.max_places = places;
    const MapSurvey found = survey(map, few);
    EXPECT_EQ(found.distinct + found.sparse, places / 2);
    EXPECT_GT(found.distinct, 0);
    EXPECT_EQ(found.bare, places / 2);
    EXPECT_NEAR(found.ground_m2, 2.0 * 800.0 * 800.0, 1.0);
  }
}

TEST(MapSurvey, CountsNoGroundBeyondTheMapWhereAFootprintIsLarger) {
  RoadGrid ground = testing::street_map(22, {2.0, {300'000, -3'200'000}, 450, 450});
  SurveyOptions large = options();
  large.query.footprint_m = 1200.0;
  const MapSurvey found = survey(view_of(ground), large);
  EXPECT_EQ(found.places(), 1);
  EXPECT_NEAR(found.ground_m2, 900.0 * 900.0, 1.0);
}

TEST(MapSurvey, OfAnEmptyMapAsksNothing) {
  MapView map = town_fields_and_unknown_ground();
  map.extent = {{1.0, 1.0}, {0.0, 0.0}};
  EXPECT_EQ(survey(map, options()).places(), 0);
}

TEST(MapSurvey, StopsWhereItIsAskedTo) {
  std::stop_source stop;
  stop.request_stop();
  SurveyOptions stopped = options();
  stopped.query.fix.search.deadline = Deadline(stop.get_token());
  EXPECT_EQ(testing::code_of([&] { survey(town_fields_and_unknown_ground(), stopped); }), "search-stopped");
}

}  // namespace
}  // namespace roadfix
