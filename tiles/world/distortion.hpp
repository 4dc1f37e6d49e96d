// A smooth displacement of the plane that bends what was laid out straight.
#pragma once

#include <span>
#include <vector>

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

class Distortion {
 public:
  /// A sum of waves of about these lengths; `strength` is the share of its length that each of them moves a point.
  Distortion(Random& random, std::span<const double> lengths_m, double strength);

  /// Where the point comes to lie.
  PlanPoint operator()(PlanPoint p) const;
  /// The way from one point to the other, bent, with a point at least every `step_m`.
  Polyline bent(PlanPoint from, PlanPoint to, double step_m) const;

 private:
  struct Wave {
    PlanPoint frequency;  ///< radians per metre along each axis
    PlanPoint amplitude;  ///< metres
    double phase = 0.0;   ///< radians
  };
  std::vector<Wave> waves_;
};

}  // namespace roadfix::world
