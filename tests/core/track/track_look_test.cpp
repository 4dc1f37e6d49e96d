#include "core/track/track_look.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/flight.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix {
namespace {

/// A frame over the town, and a belief somewhere.
class TrackLook : public ::testing::Test {
 protected:
  Look look_from(GridPose believed, double flown_m = 0.0) const {
    Cluster belief;
    belief.mean = believed;
    return look_around(search_, view_, frame_, belief, LookArea::around(believed, flown_m));
  }
  GridPose beside(double east_m) const {
    return {{truth_.position.east_m + east_m, truth_.position.north_m}, truth_.heading};
  }

  const RoadGrid map_ = testing::street_map(51, {2.0, {300'000, -3'200'000}, 800, 700});
  const MapView view_ = testing::view_of(map_);
  const GridPose truth_{{600'700.0, 6'399'400.0}, Angle::degrees(60.0)};
  TrackSettings settings_;
  StepLimits limits_;
  const TrackSearch search_{view_, settings_, limits_};
  std::mt19937_64 random_{3};
  const FeatureMap frame_ = testing::observed_at(map_, truth_, 128, 128, 2.0, {0.15, 0.15}, random_);
};

TEST(LookArea, CoversAReachOfWhichNothingLiesBeyondIt) {
  const GridPose belief{{100.0, 200.0}, Angle::degrees(355.0)};
  const LookArea area = LookArea::around(belief, 0.0);
  const auto reach = [](double east_m, double heading_deg, double radius_m, double half_deg) {
    return Reach{{100.0 + east_m, 200.0}, Angle::degrees(heading_deg), radius_m, Angle::degrees(half_deg)};
  };
  EXPECT_TRUE(area.covers(reach(0.0, 355.0, 60.0, 15.0)));
  EXPECT_TRUE(area.covers(reach(-25.0, 3.0, 30.0, 6.0)));
  EXPECT_FALSE(area.covers(reach(-35.0, 3.0, 30.0, 6.0))) << "beyond its rim";
  EXPECT_FALSE(area.covers(reach(-25.0, 6.0, 30.0, 6.0))) << "turned farther";
  const LookArea all = LookArea::of(reach(-70.0, 90.0, 20.0, 180.0), area);
  EXPECT_TRUE(all.covers(reach(-70.0, 90.0, 20.0, 180.0)));
  EXPECT_EQ(all.radius_m, area.radius_m);
}

TEST_F(TrackLook, BearsOutAPlaceThatIsRight) {
  const Look look = look_from(beside(3.0));
  EXPECT_EQ(look.outcome, Look::Outcome::kBorneOut);
  EXPECT_TRUE(look.places.empty());
}

TEST_F(TrackLook, FindsTheVehicleBesideAndFartherAwayTheFartherItFlew) {
  const Look near = look_from(beside(45.0));
  ASSERT_EQ(near.outcome, Look::Outcome::kElsewhere);
  EXPECT_LT(distance_m(near.places.at(0).mean.position, truth_.position), 5.0);

  const Look flown_little = look_from(beside(110.0));
  EXPECT_NE(flown_little.outcome, Look::Outcome::kBorneOut);
  const Look flown_far = look_from(beside(110.0), 140.0);
  ASSERT_EQ(flown_far.outcome, Look::Outcome::kElsewhere);
  EXPECT_LT(distance_m(flown_far.places.at(0).mean.position, truth_.position), 5.0);
}

// Two roads 120 m apart bore out 14 of 120 such beliefs while a frame that fits as well farther along counted, too.
TEST_F(TrackLook, IsOpenAlongStraightRoadsWithoutACrossing) {
  for (const int rows_apart : {0, 60}) {
    RoadGrid roads = map_;
    for (int row = 0; row < roads.cells.rows(); ++row) {
      const bool on_road = std::abs(row - 320) < 2 || std::abs(row - 320 - rows_apart) < 2;
      std::ranges::fill(roads.cells.row(row), on_road ? kRoad : kNoRoad);
    }
    const MapView view = testing::view_of(roads);
    const TrackSearch search(view, settings_, limits_);
    const GridPose truth{{600'700.0, roads.geometry.cell_center(0, 320).north_m}, Angle::degrees(60.0)};
    for (const double behind_m : {0.0, 45.0}) {
      Cluster belief;
      belief.mean = {{truth.position.east_m - behind_m, truth.position.north_m}, truth.heading};
      belief.covariance[0][0] = 15.0 * 15.0;  // along the roads
      for (const std::uint64_t seed : {3U, 9U, 10U, 24U}) {
        std::mt19937_64 random(seed);
        const FeatureMap frame = testing::observed_at(roads, truth, 128, 128, 2.0, {0.2, 0.1}, random);
        EXPECT_EQ(look_around(search, view, frame, belief, LookArea::around(belief.mean, 0.0)).outcome,
                  Look::Outcome::kOpen)
            << rows_apart << " rows apart, " << behind_m << " m behind, seed " << seed;
      }
    }
  }
}

TEST_F(TrackLook, FindsTheVehicleThereWithTheHeadingThatItHas) {
  const auto turned = [&](double degrees) {
    return look_from({truth_.position, truth_.heading + Angle::degrees(degrees)});
  };
  EXPECT_EQ(turned(2.0).outcome, Look::Outcome::kBorneOut);
  EXPECT_EQ(turned(-2.0).outcome, Look::Outcome::kBorneOut);
  for (const double degrees : {5.0, -8.0}) {
    const Look look = turned(degrees);
    ASSERT_EQ(look.outcome, Look::Outcome::kTurned) << degrees;
    EXPECT_LT(angular_distance(look.places.at(0).mean.heading, truth_.heading).degrees(), 1.0);
  }
}

TEST_F(TrackLook, SeesThatAFrameFitsBetterTurnedBeyondWhatTheBeliefLeavesOpen) {
  const auto better = [&](double degrees, double sigma_deg = 1.0) {
    Cluster belief;
    belief.mean = {truth_.position, truth_.heading + Angle::degrees(degrees)};
    belief.covariance[2][2] = std::pow(Angle::degrees(sigma_deg).radians(), 2);
    return fits_better_turned(view_, frame_, belief);
  };
  EXPECT_FALSE(better(0.0));
  EXPECT_FALSE(better(1.0));
  EXPECT_FALSE(better(-1.0));
  EXPECT_TRUE(better(4.0));
  EXPECT_TRUE(better(-8.0));
  EXPECT_TRUE(better(12.0));
  EXPECT_FALSE(better(4.0, 4.0));
}

TEST_F(TrackLook, BearsOutNoPlaceFarFromTheVehicleHoweverUnsureTheBelief) {
  Cluster belief;
  belief.mean = beside(45.0);
  belief.covariance[0][0] = belief.covariance[1][1] = 50.0 * 50.0;
  EXPECT_EQ(look_around(search_, view_, frame_, belief, LookArea::around(belief.mean, 0.0)).outcome,
            Look::Outcome::kOpen);
}

TEST_F(TrackLook, FindsTheVehicleBesideAtTheScaleThatIsBelieved) {
  Cluster belief;
  belief.mean = beside(45.0);
  belief.log_scale = 0.1;
  std::mt19937_64 random(4);
  FeatureMap frame = testing::observed_at(map_, truth_, 128, 128, 2.0 * std::exp(0.1), {0.15, 0.15}, random);
  frame.cell_m = 2.0;
  const Look look = look_around(search_, view_, frame, belief, LookArea::around(belief.mean, 0.0));
  ASSERT_EQ(look.outcome, Look::Outcome::kElsewhere);
  EXPECT_LT(distance_m(look.places.at(0).mean.position, truth_.position), 5.0);
  EXPECT_NEAR(look.places[0].log_scale, 0.1, 0.01);
}

TEST_F(TrackLook, IsOpenBeyondTheMap) { EXPECT_EQ(look_from(beside(5000.0)).outcome, Look::Outcome::kOpen); }

TEST(LookAge, CountsTimeAndWay) {
  EXPECT_FALSE((LookAge{2'900'000, 44.0}).is_due());
  EXPECT_TRUE((LookAge{3'000'000, 0.0}).is_due());
  EXPECT_TRUE((LookAge{0, 45.0}).is_due());
  EXPECT_FALSE((LookAge{5'900'000, 89.0}).is_outdated());
  EXPECT_TRUE((LookAge{0, 90.0}).is_outdated());
}

}  // namespace
}  // namespace roadfix
