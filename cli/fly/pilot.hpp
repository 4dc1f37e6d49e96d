// Where the vehicle steers next.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cli/evaluation/random.hpp"
#include "core/units/planar.hpp"

namespace roadfix::fly {

/// What the vehicle can do.
struct Handling {
  double speed_m_s = 15.0;
  Angle turn_rate = Angle::degrees(10.0);  ///< the fastest, per second
  double step_s = 1.0;
};

class Pilot {
 public:
  virtual ~Pilot() = default;
  virtual GridPose start(evaluation::Random& random) = 0;
  /// Turn of the next step, clockwise; nullopt when the plan is flown.
  virtual std::optional<Angle> steer(const GridPose& pose, evaluation::Random& random) = 0;
};

/// Wanders within the box: the rate of turn changes at random, and near the rim it heads back to the middle.
std::unique_ptr<Pilot> make_random_pilot(const GridBox& box, const Handling& handling);

/// Flies from point to point and starts at the first, heading for the second. At least two points.
std::unique_ptr<Pilot> make_waypoint_pilot(std::vector<GridPoint> points, const Handling& handling);

/// Lanes from west to east and back, `spacing_m` apart, from the south-western corner.
std::vector<GridPoint> survey_lanes(const GridBox& box, double spacing_m);

}  // namespace roadfix::fly
