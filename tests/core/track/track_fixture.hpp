// A vehicle over a town of 1600 x 1400 m that a map shows as it is.
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "core/track/tracker.hpp"
#include "tests/support/flight.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix::testing {

class Track : public ::testing::Test {
 protected:
  using Look = std::function<void(int step, const TrackEstimate& estimate)>;

  RoadGrid map_ = street_map(51, {2.0, {300'000, -3'200'000}, 800, 700});
  MapView view_ = view_of(map_);
  GridPose start_{{600'700.0, 6'399'400.0}, Angle::degrees(60.0)};
  TrackerState state_;

  static TrackSettings settings() {
    TrackSettings s;
    s.filter.max_particles = 4000;
    s.filter.min_particles = 500;
    return s;
  }
  double error_m(const TrackEstimate& estimate, const GridPose& truth) const {
    return distance_m(view_.zone.project(estimate.clusters.at(0).pose.position), truth.position);
  }

  Angle heading_error(const TrackEstimate& estimate, const GridPose& truth) const {
    const GeoPose& claimed = estimate.clusters.at(0).pose;
    const Angle grid = view_.zone.grid_from_true(claimed.heading, view_.zone.project(claimed.position));
    return angular_distance(grid, truth.heading);
  }

  TrackEstimate advance(const Tracker& tracker, const StepInput& step) {
    StepResult result = tracker.advance(state_, step);
    state_ = std::move(result.state);
    return std::move(result.estimate);
  }
  /// So many steps that see the ground; the last estimate.
  TrackEstimate fly(
      const Tracker& tracker, Flight& flight, int steps, const Look& look = [](int, const TrackEstimate&) {}) {
    TrackEstimate last;
    for (int i = 0; i < steps; ++i) {
      last = advance(tracker, flight.step());
      look(i, last);
    }
    return last;
  }
};

}  // namespace roadfix::testing
