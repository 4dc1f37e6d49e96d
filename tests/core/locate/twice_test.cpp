// Streets that a map holds twice, closer together than places that count as distinct.
#include <algorithm>
#include <cmath>

#include "core/grid/cell.hpp"
#include "tests/core/locate/locate_fixture.hpp"
#include "tests/support/random_pose.hpp"

namespace roadfix {
namespace {

using testing::observed_at;
using testing::pose_within;

class LocateTwice : public testing::Locate {
 protected:
  static constexpr int kFrameCells = 200;

  /// The map with another source beside it, whose georeference is wrong by so many cells.
  RoadGrid with_copy(int east, int south) const {
    RoadGrid both = map_;
    for (int row = south; row < both.cells.rows(); ++row) {
      for (int col = east; col < both.cells.cols(); ++col) {
        both.cells.at(col, row) = std::max(map_.cells.at(col, row), map_.cells.at(col - east, row - south));
      }
    }
    return both;
  }

  Prior around(const GridPose& truth) const {
    Prior prior;
    prior.circle = GeoCircle{on_earth(truth, view_.zone).position, 400.0};
    return prior;
  }
};

TEST_F(LocateTwice, AFixIsGivenForNeitherOfTwoCopiesOfTheStreets) {
  const RoadGrid twice = with_copy(12, 8);  // 29 m
  const MapView view = testing::view_of(twice);
  int alone = 0;
  for (int i = 0; i < 3; ++i) {
    const GridPose truth = pose_within(view_.extent, 500.0, random_);
    const FeatureMap frame = observed_at(map_, truth, kFrameCells, kFrameCells, 2.0, {0.2, 0.2}, random_);
    alone += locate(view_, frame, around(truth), {}).status == FixStatus::kFix ? 1 : 0;
    const Fix fix = locate(view, frame, around(truth), {});
    EXPECT_EQ(fix.status, FixStatus::kAmbiguous);
    ASSERT_GE(fix.modes.size(), 2U);
    const double nearer = std::min(error_m(fix.modes[0].pose, truth), error_m(fix.modes[1].pose, truth));
    const double farther = std::max(error_m(fix.modes[0].pose, truth), error_m(fix.modes[1].pose, truth));
    EXPECT_LT(nearer, 5.0);
    EXPECT_NEAR(farther, std::hypot(24.0, 16.0), 5.0);
  }
  EXPECT_GE(alone, 2);
}

TEST_F(LocateTwice, CopiesWithinTheErrorThatTheMapStatesAreOnePlace) {
  const RoadGrid twice = with_copy(4, 2);  // 9 m
  MapView view = testing::view_of(twice);
  view.registration_sigma_m = [](GridPoint) { return 6.0; };
  int fixes = 0;
  for (int i = 0; i < 3; ++i) {
    const GridPose truth = pose_within(view_.extent, 500.0, random_);
    const FeatureMap frame = observed_at(map_, truth, kFrameCells, kFrameCells, 2.0, {0.2, 0.2}, random_);
    fixes += locate(view, frame, around(truth), {}).status == FixStatus::kFix ? 1 : 0;
  }
  EXPECT_GE(fixes, 2);
}

TEST_F(LocateTwice, CopiesFartherApartThanOnePlaceAreTwoHoweverBadlyTheMapIsRegistered) {
  const RoadGrid twice = with_copy(12, 8);  // 29 m
  MapView view = testing::view_of(twice);
  view.registration_sigma_m = [](GridPoint) { return 16.0; };
  for (int i = 0; i < 3; ++i) {
    const GridPose truth = pose_within(view_.extent, 500.0, random_);
    const FeatureMap frame = observed_at(map_, truth, kFrameCells, kFrameCells, 2.0, {0.2, 0.2}, random_);
    EXPECT_NE(locate(view, frame, around(truth), {}).status, FixStatus::kFix);
  }
}

}  // namespace
}  // namespace roadfix
