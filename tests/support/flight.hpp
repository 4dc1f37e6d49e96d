// A UAV that flies over an invented town: its truth, its odometry, and what it sees.
#pragma once

#include <cmath>
#include <random>

#include "core/track/tracker.hpp"
#include "core/units/draws.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix::testing {

class Flight {
 public:
  Flight(const RoadGrid& map, GridPose start, std::uint64_t seed) : map_(map), pose_(start), random_(seed) {}

  const GridPose& pose() const { return pose_; }
  void jump_to(const GridPose& pose) { pose_ = pose; }

  /// The next step: so far ahead with a gentle turn, away from the edge of the map.
  StepInput step(bool sees = true) {
    StepInput input;
    input.sequence = sequence_++;
    input.time_us = 1'000'000 * (input.sequence + 1);
    if (input.sequence > 0) input.odometry = move();
    if (sees) input.features = observed_at(map_, pose_, side_cells, side_cells, 2.0, noise, random_);
    return input;
  }

  DetectorNoise noise{0.15, 0.15};
  int side_cells = 128;
  double step_m = 20.0;

 private:
  Odometry move() {
    const GridBox box = map_.geometry.box();
    const GridPoint middle = box.centre();
    const double to_middle = std::atan2(middle.east_m - pose_.position.east_m, middle.north_m - pose_.position.north_m);
    const bool near_edge = distance_m(pose_.position, middle) > 0.3 * std::min(box.width_m(), box.height_m());
    const Angle home = (Angle::radians(to_middle) - pose_.heading).wrapped();
    const Angle turn =
        near_edge ? Angle::radians(std::clamp(home.radians(), -0.2, 0.2)) : Angle::radians(uniform(random_, -0.1, 0.1));
    pose_ = moved(pose_, {step_m, 0.0, turn});
    return {step_m * uniform(random_, 0.97, 1.03), uniform(random_, -0.3, 0.3),
            turn + Angle::degrees(uniform(random_, -0.5, 0.5))};
  }

  const RoadGrid& map_;
  GridPose pose_;
  std::mt19937_64 random_;
  std::int64_t sequence_ = 0;
};

}  // namespace roadfix::testing
