// A track whose vehicle leaves the ground that the map shows.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "core/track/tracker.hpp"
#include "tests/core/track/track_fixture.hpp"

namespace roadfix {
namespace {

using testing::Track;

/// The town of Track, of which the map knows only what lies west of a line, and a vehicle that flies east.
class TrackBeyondTheMap : public Track {
 protected:
  TrackBeyondTheMap() {
    part_.read = [whole = view_.read](const GridGeometry& geometry) {
      RoadGrid grid = whole(geometry);
      for (int row = 0; row < grid.geometry.rows; ++row) {
        for (int col = 0; col < grid.geometry.cols; ++col) {
          if (grid.geometry.cell_center(col, row).east_m > 600'950.0) grid.cells.at(col, row) = kUnobserved;
        }
      }
      return grid;
    };
  }

  TrackEstimate fly_to(const Tracker& tracker, const GridPose& pose, double seconds) {
    StepInput step;
    if (state_.last) {
      step.sequence = state_.last->sequence + 1;
      step.time_us = state_.last->time_us + static_cast<std::int64_t>(1e6 * seconds);
      step.odometry = Odometry{20.0, 0.0, Angle()};
    }
    step.features = testing::observed_at(map_, pose, 128, 128, 2.0, {0.1, 0.1}, random_);
    return advance(tracker, step);
  }
  /// 28 steps; the last ones see nothing that the map shows.
  TrackEstimate fly_out(const Tracker& tracker) {
    TrackEstimate last;
    for (int i = 0; i < 28; ++i) {
      last = fly_to(tracker, {{600'650.0 + 20.0 * i, 6'399'400.0}, Angle::degrees(90.0)}, 1.0);
      if (i == 8) {
        EXPECT_LT(error_m(last, {{600'650.0 + 20.0 * i, 6'399'400.0}, Angle::degrees(90.0)}), 25.0);
      }
    }
    return last;
  }

  MapView part_ = view_;
  std::mt19937_64 random_{12};
};

TEST_F(TrackBeyondTheMap, TakesNothingFromFramesOfGroundThatTheMapDoesNotShow) {
  const TrackEstimate last = fly_out(Tracker(part_, settings()));
  EXPECT_EQ(last.measurement, Measurement::kUseless);
  EXPECT_LT(last.doubt, 0.4) << "nothing speaks against the belief";
  EXPECT_LT(error_m(last, {{600'650.0 + 20.0 * 27, 6'399'400.0}, Angle::degrees(90.0)}), 40.0);
}

TEST_F(TrackBeyondTheMap, SearchesAnewWhereNothingWasAcceptedForAMinute) {
  const Tracker tracker(part_, settings());
  fly_out(tracker);
  // In truth it is elsewhere, over ground that the map shows; where it believes to be, no frame can tell.
  GridPose pose{{600'420.0, 6'398'900.0}, Angle::degrees(90.0)};
  TrackEstimate last;
  for (int i = 0; i < 14; ++i, pose.position.east_m += 20.0) last = fly_to(tracker, pose, 10.0);
  EXPECT_LT(error_m(last, {{pose.position.east_m - 20.0, pose.position.north_m}, pose.heading}), 20.0);
}

TEST_F(TrackBeyondTheMap, ClaimsNoPlaceOnTheMapForGroundFarBesideIt) {
  const RoadGrid elsewhere = testing::street_map(77, {2.0, {300'000, -3'200'000}, 2500, 700});
  const Tracker tracker(part_, settings());
  fly_out(tracker);
  GridPose pose{{600'650.0 + 20.0 * 28, 6'399'400.0}, Angle::degrees(90.0)};
  for (int i = 0; i < 150; ++i, pose.position.east_m += 20.0) {
    StepInput step;
    step.sequence = state_.last.value().sequence + 1;
    step.time_us = state_.last.value().time_us + 2'000'000;
    step.odometry = Odometry{20.0, 0.0, Angle()};
    step.features = testing::observed_at(elsewhere, pose, 128, 128, 2.0, {0.1, 0.1}, random_);
    const TrackEstimate estimate = advance(tracker, step);
    EXPECT_FALSE(estimate.converged() && error_m(estimate, pose) > 25.0) << "step " << i;
  }
}

}  // namespace
}  // namespace roadfix
