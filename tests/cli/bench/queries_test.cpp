#include "cli/bench/queries.hpp"

#include <gtest/gtest.h>

#include "core/units/error.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix::bench {
namespace {

double from_the_centre_of_the_prior_m(const Query& query, const UtmZone& zone) {
  return distance_m(zone.project(query.prior.circle.value().centre), zone.project(query.truth.value().position));
}

TEST(Queries, TellACircleThatHoldsTheTruthOrOneThatItLiesSoFarBeyond) {
  const MapView map = testing::view_of(testing::street_map(5, {2.0, {300'000, -3'200'000}, 500, 400}));
  QuerySet set;
  set.kind = QuerySet::Kind::kSimulated;
  set.count = 20;
  set.footprint = {200.0, 200.0};
  set.prior_radius_m = 100.0;
  for (const Query& query : make_queries(set, map, map, {})) {
    EXPECT_LE(from_the_centre_of_the_prior_m(query, map.zone), 100.0);
  }
  set.prior_beyond_m = 30.0;
  for (const Query& query : make_queries(set, map, map, {})) {
    EXPECT_NEAR(from_the_centre_of_the_prior_m(query, map.zone), 130.0, 0.01);
    EXPECT_EQ(query.prior.circle->radius_m, 100.0);
  }
}

TEST(Queries, TellAHeadingWithinARangeOfTheTrueOne) {
  const MapView map = testing::view_of(testing::street_map(5, {2.0, {300'000, -3'200'000}, 500, 400}));
  QuerySet set;
  set.kind = QuerySet::Kind::kSimulated;
  set.count = 20;
  set.footprint = {200.0, 200.0};
  set.prior_heading_range = Angle::degrees(20.0);
  double farthest_deg = 0.0;
  for (const Query& query : make_queries(set, map, map, {})) {
    EXPECT_FALSE(query.prior.circle);
    EXPECT_EQ(query.prior.heading.value().half_width, Angle::degrees(20.0));
    farthest_deg =
        std::max(farthest_deg, angular_distance(query.prior.heading->centre, query.truth.value().heading).degrees());
  }
  EXPECT_LE(farthest_deg, 20.0);
  EXPECT_GT(farthest_deg, 10.0) << "it is not the true one";
}

TEST(Queries, TellOnlyCirclesThatMeetTheMap) {
  const MapView map = testing::view_of(testing::street_map(5, {2.0, {300'000, -3'200'000}, 500, 400}));
  QuerySet set;
  set.kind = QuerySet::Kind::kSimulated;
  set.count = 20;
  set.footprint = {200.0, 200.0};
  set.prior_radius_m = 100.0;
  set.prior_beyond_m = 400.0;
  for (const Query& query : make_queries(set, map, map, {})) {
    EXPECT_NO_THROW(region_of(map, query.prior)) << query.id;
    EXPECT_NEAR(from_the_centre_of_the_prior_m(query, map.zone), 500.0, 0.01);
  }
  set.prior_beyond_m = 2000.0;
  EXPECT_THROW(make_queries(set, map, map, {}), InvalidInput);
}

}  // namespace
}  // namespace roadfix::bench
