#include "core/locate/beyond_prior.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "core/locate/fix.hpp"
#include "tests/support/map_view.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

constexpr PoseRegion kRegion{.box = {{0.0, 0.0}, {1000.0, 800.0}},
                             .circle = GridCircle{{500.0, 400.0}, 400.0},
                             .heading = Angle::degrees(30.0),
                             .heading_half_width = Angle::degrees(10.0)};

SearchMode mode_at(double east_m, double north_m, double score) {
  SearchMode mode;
  mode.pose.position = {east_m, north_m};
  mode.score = score;
  mode.covariance[0][0] = mode.covariance[1][1] = 4.0;
  return mode;
}

SearchResult found(std::vector<SearchMode> modes) {
  SearchResult result;
  result.background.sd = 0.05;
  result.modes = std::move(modes);
  return result;
}

Decision fix_of(const SearchResult& result) {
  Decision decision;
  decision.status = FixStatus::kFix;
  decision.probability = 0.995;
  decision.weights.assign(result.modes.size(), 0.001);
  decision.weights.front() = 0.995;
  return decision;
}

class BeyondPrior : public ::testing::Test {
 protected:
  SearchResult inside_ = found({mode_at(880.0, 400.0, 0.6), mode_at(300.0, 300.0, 0.2)});

  Decision confirmed_by(SearchMode near) const {
    return confirmed(fix_of(inside_), inside_, kRegion, found({near, inside_.modes.front()}));
  }
};

TEST_F(BeyondPrior, ABetterPlaceAcrossTheBorderTakesTheFixBack) {
  const Decision decision = confirmed_by(mode_at(940.0, 400.0, 0.7));
  EXPECT_EQ(decision.status, FixStatus::kNoFix);
  EXPECT_EQ(decision.reason, "better-outside-prior");
  EXPECT_NE(decision.explanation.find("60 m"), std::string::npos) << decision.explanation;
  EXPECT_LT(decision.probability, 0.5);
  EXPECT_DOUBLE_EQ(decision.weights[0], decision.probability);
  EXPECT_LE(std::accumulate(decision.weights.begin(), decision.weights.end(), 0.0), 1.0);
}

TEST_F(BeyondPrior, AWorsePlaceThereChangesNothing) {
  const Decision decision = confirmed_by(mode_at(940.0, 400.0, 0.59));
  EXPECT_EQ(decision.status, FixStatus::kFix);
  EXPECT_EQ(decision.probability, 0.995);
  EXPECT_TRUE(decision.reason.empty());
}

TEST_F(BeyondPrior, TheSamePlaceFoundAgainChangesNothing) {
  inside_.modes[0] = mode_at(898.0, 400.0, 0.6);
  EXPECT_EQ(confirmed_by(mode_at(901.0, 401.0, 0.61)).status, FixStatus::kFix);
}

TEST_F(BeyondPrior, APlaceInsideIsNotBeyond) {
  EXPECT_EQ(confirmed_by(mode_at(850.0, 400.0, 0.7)).status, FixStatus::kFix);
}

TEST_F(BeyondPrior, ASearchThatCouldNotFinishConfirmsNothing) {
  SearchResult near = found({});
  near.scanned_share = 0.5;
  const Decision decision = confirmed(fix_of(inside_), inside_, kRegion, near);
  EXPECT_EQ(decision.status, FixStatus::kNoFix);
  EXPECT_EQ(decision.reason, "search-time-limit");
}

TEST_F(BeyondPrior, LooksHalfAFootprintBeyondTheBorderWhereThePlaceIsNear) {
  const FeatureMap features = FeatureMap::centred(CellArray(100, 50, kNoRoad), 4.0);
  constexpr GridBox kMap{{-2000.0, -2000.0}, {3000.0, 3000.0}};
  const auto near = ground_beyond(kRegion, kMap, {{500.0, 400.0}, {}}, features);
  ASSERT_TRUE(near);
  EXPECT_TRUE(near->contains(GridPoint{1099.0, 400.0}));
  EXPECT_FALSE(near->contains(GridPoint{1101.0, 400.0}));
  EXPECT_TRUE(near->contains(Angle::degrees(39.0)));
  EXPECT_FALSE(near->contains(Angle::degrees(41.0)));
}

TEST_F(BeyondPrior, LooksNoFartherThanTheMapAndAKilometreAround) {
  const FeatureMap features = FeatureMap::centred(CellArray(100, 50, kNoRoad), 4.0);
  const GridPose middle{{500.0, 400.0}, {}};
  EXPECT_FALSE(ground_beyond({.box = kRegion.box, .circle = {}, .heading = {}}, kRegion.box, middle, features))
      << "nothing but the map was asked for";
  constexpr GridBox kCountry{{-50e3, -50e3}, {50e3, 50e3}};
  PoseRegion large = kRegion;
  large.box = kCountry;
  large.circle = GridCircle{middle.position, 9000.0};
  EXPECT_FALSE(ground_beyond(large, kCountry, middle, features)) << "far from the border";
  const auto near = ground_beyond(large, kCountry, {{9400.0, 400.0}, {}}, features);
  ASSERT_TRUE(near);
  EXPECT_TRUE(near->contains(GridPoint{9690.0, 400.0}));
  EXPECT_FALSE(near->contains(GridPoint{8300.0, 400.0}));
}

// A confidence so low that the best place inside would be a fix.
TEST(BeyondAPriorThatIsWrong, TheTruthIsSoughtSoThatAPlaceLikeItIsNoFix) {
  const RoadGrid map = testing::street_map(34, {2.0, {300'000, -3'200'000}, 1000, 800});
  const MapView view = testing::view_of(map);
  std::mt19937_64 random(34);
  const GridPose truth = testing::pose_within(view.extent, 500.0, random);
  const FeatureMap seen = testing::observed_at(map, truth, 200, 200, 2.0, {0.2, 0.2}, random);
  Prior prior;
  prior.circle = GeoCircle{view.zone.unproject({truth.position.east_m + 290.0, truth.position.north_m}), 250.0};
  FixOptions options;
  options.confidence = 0.1;
  const Fix wrong = locate(view, seen, prior, options);
  EXPECT_EQ(wrong.status, FixStatus::kNoFix);
  EXPECT_EQ(wrong.reason, "better-outside-prior");
  prior.circle->radius_m = 300.0;
  const Fix right = locate(view, seen, prior, {});
  ASSERT_EQ(right.status, FixStatus::kFix) << right.reason;
  EXPECT_LT(distance_m(view.zone.project(right.modes[0].pose.position), truth.position), 2.0);
}

}  // namespace
}  // namespace roadfix
