#include "core/survey/route_survey.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "tests/core/survey/town_and_fields.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::counted;
using testing::query_of_a_third;
using testing::town_fields_and_unknown_ground;

/// The map's box is 1200 x 800 m, of which the western 800 m are observed.
constexpr GridPoint kSouthWest{600'000.0, 6'399'200.0};

routes::Route route_of(const MapView& map, const std::vector<GridPoint>& from_south_west) {
  routes::Route route;
  for (const GridPoint point : from_south_west) {
    const LatLon at = map.zone.unproject({kSouthWest.east_m + point.east_m, kSouthWest.north_m + point.north_m});
    route.places.push_back({at, std::nullopt, {}});
  }
  return route;
}

RouteSurveyOptions route_options() {
  RouteSurveyOptions options;
  options.query = query_of_a_third();
  options.every_m = 400.0;
  return options;
}

std::vector<PlaceKind> kinds_of(const RouteSurvey& survey) {
  std::vector<PlaceKind> kinds;
  for (const RoutePiece& piece : survey.pieces) kinds.push_back(piece.kind);
  return kinds;
}

using enum PlaceKind;

TEST(RouteSurvey, TellsWhereAFlightHasFixesAndHowLongItGoesWithoutOne) {
  const MapView map = town_fields_and_unknown_ground();
  RouteSurveyOptions two_at_a_time = route_options();
  two_at_a_time.threads = 2;
  std::int64_t told = 0;
  two_at_a_time.progress = counted(told, 8);
  // Eastwards over town, fields and what is not known, out of the map, and back over the fields to the town.
  const RouteSurvey found =
      survey_route(map, route_of(map, {{0, 400}, {1600, 400}, {1600, 400}, {0, 400}}), two_at_a_time);
  EXPECT_EQ(told, 8);
  EXPECT_TRUE(found.complete());
  EXPECT_NEAR(found.length_m, 3200.0, 0.01);
  EXPECT_EQ(kinds_of(found), (std::vector{kDistinct, kBare, kUnknown, kUnknown, kUnknown, kUnknown, kBare, kDistinct}));
  EXPECT_EQ(found.count(kUnknown), 4);
  EXPECT_GT(found.pieces.front().probability, 0.9);
  ASSERT_TRUE(found.first_fix_m());
  EXPECT_DOUBLE_EQ(*found.first_fix_m(), 0.0);
  EXPECT_EQ(found.longest_without_fix().first, 1);
  EXPECT_EQ(found.longest_without_fix().end, 7);
}

TEST(RouteSurvey, PiecesAreOfOneLengthAndFollowTheTurnsOfTheRoute) {
  const MapView map = town_fields_and_unknown_ground();
  RouteSurveyOptions halves = route_options();
  halves.every_m = 500.0;
  const routes::Route route = route_of(map, {{100, 100}, {100, 400}, {800, 400}});
  const RouteSurvey found = survey_route(map, route, halves);
  ASSERT_EQ(found.pieces.size(), 2U);
  EXPECT_NEAR(found.piece_m, 500.0, 0.01);
  const auto expect_place = [&](LatLon place, double east_m, double north_m) {
    const GridPoint point = map.zone.project(place);
    EXPECT_NEAR(point.east_m - kSouthWest.east_m, east_m, 0.01);
    EXPECT_NEAR(point.north_m - kSouthWest.north_m, north_m, 0.01);
  };
  ASSERT_EQ(found.pieces[0].line.size(), 3U);
  expect_place(found.pieces[0].line[0], 100, 100);
  expect_place(found.pieces[0].line[1], 100, 400);
  expect_place(found.pieces[0].line[2], 300, 400);
  ASSERT_EQ(found.pieces[1].line.size(), 2U);
  expect_place(found.pieces[1].line[0], 300, 400);
  expect_place(found.pieces[1].line[1], 800, 400);
}

TEST(RouteSurvey, AsksAtFewerPlacesThatStandForLongerPiecesWhereItWouldBeTooMany) {
  const MapView map = town_fields_and_unknown_ground();
  RouteSurveyOptions few = route_options();
  few.every_m = 1.0;
  few.max_places = 2;
  const RouteSurvey found = survey_route(map, route_of(map, {{0, 400}, {800, 400}}), few);
  EXPECT_EQ(kinds_of(found), (std::vector{kDistinct, kBare}));
  EXPECT_EQ(found.longest_without_fix().count(), 1);
}

TEST(RouteSurvey, GoesOnWhereAnotherOneEnded) {
  const MapView map = town_fields_and_unknown_ground();
  const routes::Route route = route_of(map, {{0, 400}, {1600, 400}});
  RouteSurveyOptions rest = route_options();
  rest.from_m = 400.0;
  const RouteSurvey found = survey_route(map, route, rest);
  EXPECT_EQ(kinds_of(found), (std::vector{kBare, kUnknown, kUnknown}));
  EXPECT_TRUE(found.complete());
  EXPECT_NEAR(found.begin_m(0), 400.0, 0.01);
  EXPECT_FALSE(found.first_fix_m());
  EXPECT_NEAR(found.begin_m(3), 1600.0, 0.01);
  rest.limit = 2;
  const RouteSurvey part = survey_route(map, route, rest);
  EXPECT_EQ(kinds_of(part), (std::vector{kBare, kUnknown}));
  EXPECT_FALSE(part.complete());
  EXPECT_NEAR(part.begin_m(2), 1200.0, 0.01) << "where to go on";
}

TEST(RouteSurvey, BeginsAnywhereBeforeTheEndOfTheRouteAndNowhereBeyond) {
  const MapView map = town_fields_and_unknown_ground();
  const routes::Route route = route_of(map, {{0, 400}, {1600, 400}});
  RouteSurveyOptions rest = route_options();
  for (const double from_m : {1300.0, 1500.0, 1599.0}) {
    rest.from_m = from_m;
    const RouteSurvey last = survey_route(map, route, rest);
    EXPECT_EQ(kinds_of(last), std::vector{kUnknown}) << from_m;
    EXPECT_NEAR(last.begin_m(0), 1200.0, 0.01) << from_m;
    EXPECT_TRUE(last.complete()) << from_m;
  }
  for (const double from_m : {-1.0, 1601.0, 1e9, std::numeric_limits<double>::infinity()}) {
    rest.from_m = from_m;
    EXPECT_EQ(code_of([&] { survey_route(map, route, rest); }), "parameter-out-of-range") << from_m;
  }
}

TEST(RouteSurvey, TellsPlacesAlongTheWholeRouteWhereverItBegan) {
  const MapView map = town_fields_and_unknown_ground();
  RouteSurveyOptions rest = route_options();
  rest.from_m = 800.0;
  const RouteSurvey found = survey_route(map, route_of(map, {{1200, 400}, {0, 400}}), rest);
  EXPECT_EQ(kinds_of(found), std::vector{kDistinct});
  ASSERT_TRUE(found.first_fix_m());
  EXPECT_NEAR(*found.first_fix_m(), 800.0, 0.01);
}

TEST(RouteSurvey, EndsAtTheDeadlineWithWhatItHas) {
  const MapView map = town_fields_and_unknown_ground();
  RouteSurveyOptions late = route_options();
  late.query.fix.search.deadline = Deadline({}, std::chrono::steady_clock::now());
  const RouteSurvey nothing = survey_route(map, route_of(map, {{0, 400}, {1600, 400}}), late);
  EXPECT_TRUE(nothing.pieces.empty());
  EXPECT_FALSE(nothing.complete());
  EXPECT_DOUBLE_EQ(nothing.begin_m(0), 0.0) << "where to go on";
  const RouteSurvey beyond = survey_route(map, route_of(map, {{2000, 400}, {1200, 400}, {0, 400}}), late);
  EXPECT_EQ(kinds_of(beyond), (std::vector{kUnknown, kUnknown})) << "which takes no search";
}

TEST(RouteSurvey, HasNoFirstFixWhereNoneIsToBeExpected) {
  const MapView map = town_fields_and_unknown_ground();
  const RouteSurvey found = survey_route(map, route_of(map, {{500, 400}, {700, 400}}), route_options());
  EXPECT_EQ(kinds_of(found), std::vector{kBare});
  EXPECT_FALSE(found.first_fix_m());
  EXPECT_EQ(found.longest_without_fix().count(), 1);
}

/// Northwards through the town, from one height above ground to another.
routes::Route climb(const MapView& map, double from_agl_m, double to_agl_m, double length_m = 400.0) {
  routes::Route route = route_of(map, {{200, 200}, {200, 200 + length_m}});
  route.places[0].height = routes::PlannedHeight{from_agl_m, routes::HeightAbove::kGround};
  route.places[1].height = routes::PlannedHeight{to_agl_m, routes::HeightAbove::kGround};
  return route;
}

/// Of a camera whose footprint is twice as wide as it is high.
RouteSurveyOptions options_of_a_camera() {
  RouteSurveyOptions camera = route_options();
  camera.query.footprint_m = 0.0;  // not read
  camera.camera = DownwardCamera{Angle::degrees(90.0), 1.0};
  return camera;
}

TEST(RouteSurvey, AsksOfEachPlaceForTheGroundThatACameraShowsFromItsHeight) {
  const MapView map = town_fields_and_unknown_ground();
  RouteSurveyOptions camera = options_of_a_camera();
  camera.every_m = 100.0;
  const RouteSurvey found = survey_route(map, climb(map, 20.0, 220.0), camera);
  ASSERT_EQ(found.pieces.size(), 4U);
  for (const int i : {0, 1, 2, 3}) {
    const RoutePiece& piece = found.pieces[static_cast<std::size_t>(i)];
    EXPECT_NEAR(piece.agl_m.value(), 45.0 + 50.0 * i, 1e-6);
    EXPECT_NEAR(piece.footprint_m.value(), 90.0 + 100.0 * i, 1e-6);
    LocalizabilityQuery same = route_options().query;
    same.footprint_m = *piece.footprint_m;
    same.position = map.zone.unproject({kSouthWest.east_m + 200.0, kSouthWest.north_m + 250.0 + 100.0 * i});
    EXPECT_EQ(piece.kind, kind_of(localizability(map, same)));
    EXPECT_NEAR(piece.probability, localizability(map, same).probability, 1e-6);
  }
  EXPECT_EQ(found.pieces[3].kind, kDistinct);
  EXPECT_NE(found.pieces[0].kind, kDistinct) << "from so low it shows too little";
  EXPECT_NEAR(found.range(&RoutePiece::agl_m)->least_m, 45.0, 1e-6);
  EXPECT_NEAR(found.range(&RoutePiece::footprint_m)->most_m, 390.0, 1e-6);
  EXPECT_FALSE(survey_route(map, climb(map, 20.0, 220.0), route_options()).range(&RoutePiece::agl_m));
}

TEST(RouteSurvey, TakesFootprintsThatAreTooSmallForBareAndThoseTooLargeForUnknown) {
  const MapView map = town_fields_and_unknown_ground();
  const auto only_piece = [&](double agl_m) {
    return survey_route(map, climb(map, agl_m, agl_m), options_of_a_camera()).pieces.at(0);
  };
  EXPECT_EQ(only_piece(9.9).kind, kBare) << "19.8 m";
  EXPECT_EQ(only_piece(-3.0).kind, kBare) << "the plan leads into the ground";
  EXPECT_EQ(only_piece(-3.0).footprint_m, 0.0);
  EXPECT_EQ(only_piece(2501.0).kind, kUnknown);
  EXPECT_EQ(only_piece(200.0).kind, kDistinct);
}

TEST(RouteSurvey, OfACameraCutsPiecesOfHalfItsMeanFootprint) {
  const MapView map = town_fields_and_unknown_ground();
  RouteSurveyOptions camera = options_of_a_camera();
  camera.every_m.reset();
  EXPECT_NEAR(survey_route(map, climb(map, 100.0, 300.0), camera).piece_m, 200.0, 1e-6);
  // Of 0 to 100 m those from 10 m on show the 20 m and more that can be asked of: 110 m in the mean.
  EXPECT_NEAR(survey_route(map, climb(map, 0.0, 100.0, 5500.0), camera).piece_m, 55.0, 0.1);
  RouteSurveyOptions fixed = route_options();
  fixed.every_m.reset();
  EXPECT_NEAR(survey_route(map, climb(map, 0.0, 0.0), fixed).piece_m, 200.0, 1e-6) << "or of half a footprint";
}

TEST(RouteSurvey, OfACameraNeedsHeightsThatCanBecomeOnesAboveGround) {
  const MapView map = town_fields_and_unknown_ground();
  const routes::Route untold = route_of(map, {{0, 400}, {400, 400}});
  RouteSurveyOptions camera = options_of_a_camera();
  EXPECT_EQ(code_of([&] { survey_route(map, untold, camera); }), "heights-missing");
  camera.usual_agl_m = 200.0;
  EXPECT_NEAR(survey_route(map, untold, camera).pieces.at(0).footprint_m.value(), 400.0, 1e-6);
}

TEST(RouteSurvey, RefusesRoutesOfAnotherPlaceAndThoseThatLeadNowhere) {
  const MapView map = town_fields_and_unknown_ground();
  const auto code = [&](const routes::Route& route) {
    return code_of([&] { survey_route(map, route, route_options()); });
  };
  EXPECT_EQ(code(route_of(map, {{0, 5000}, {1200, 5000}})), "route-outside-map");
  const routes::Route elsewhere{{{{10.0, -120.0}, {}, {}}, {{10.0, -119.0}, {}, {}}}, {}, {}};
  EXPECT_EQ(code(elsewhere), "route-outside-map") << "where the zone is not defined";
  EXPECT_EQ(code(route_of(map, {{400, 400}, {400, 400}})), "route-without-length");
}

}  // namespace
}  // namespace roadfix
