#include "cli/fly/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix::fly {
namespace {

using evaluation::Random;

Angle bearing(GridPoint from, GridPoint to) {
  return Angle::radians(std::atan2(to.east_m - from.east_m, to.north_m - from.north_m));
}

/// The turn towards a bearing that one step allows.
Angle turn_towards(Angle target, const GridPose& pose, const Handling& handling) {
  const Angle max_turn = handling.step_s * handling.turn_rate;
  return std::clamp((target - pose.heading).wrapped(), -max_turn, max_turn);
}

class RandomPilot : public Pilot {
 public:
  RandomPilot(const GridBox& box, const Handling& handling) : box_(box), handling_(handling) {}

  GridPose start(Random& random) override {
    return {{uniform(random, box_.min.east_m, box_.max.east_m), uniform(random, box_.min.north_m, box_.max.north_m)},
            Angle::degrees(uniform(random, -180.0, 180.0))};
  }

  std::optional<Angle> steer(const GridPose& pose, Random& random) override {
    constexpr double kChange = 0.3;
    rate_ = std::clamp(rate_ + uniform(random, -kChange, kChange), -1.0, 1.0);
    const GridPoint middle = box_.centre();
    if (!box_.contains(pose.position)) return turn_towards(bearing(pose.position, middle), pose, handling_);
    return (rate_ * handling_.step_s) * handling_.turn_rate;
  }

 private:
  GridBox box_;
  Handling handling_;
  double rate_ = 0.0;  ///< share of the fastest turn
};

class WaypointPilot : public Pilot {
 public:
  WaypointPilot(std::vector<GridPoint> points, const Handling& handling)
      : points_(std::move(points)), handling_(handling) {}

  GridPose start(Random&) override {
    next_ = 1;
    return {points_[0], bearing(points_[0], points_[1])};
  }

  std::optional<Angle> steer(const GridPose& pose, Random&) override {
    // A point closer than the turning circle may never be met exactly.
    const double radius = handling_.speed_m_s / std::max(handling_.turn_rate.radians(), 1e-6);
    const double reached = std::max(handling_.speed_m_s * handling_.step_s, std::min(radius, kFurthestM));
    while (next_ < points_.size() && distance_m(pose.position, points_[next_]) <= reached) ++next_;
    if (next_ == points_.size()) return std::nullopt;
    return turn_towards(bearing(pose.position, points_[next_]), pose, handling_);
  }

 private:
  static constexpr double kFurthestM = 200.0;
  std::vector<GridPoint> points_;
  Handling handling_;
  std::size_t next_ = 1;
};

}  // namespace

std::unique_ptr<Pilot> make_random_pilot(const GridBox& box, const Handling& handling) {
  return std::make_unique<RandomPilot>(box, handling);
}

std::unique_ptr<Pilot> make_waypoint_pilot(std::vector<GridPoint> points, const Handling& handling) {
  if (points.size() < 2) throw InvalidInput("waypoints-unreadable", "a flight needs at least two waypoints");
  return std::make_unique<WaypointPilot>(std::move(points), handling);
}

std::vector<GridPoint> survey_lanes(const GridBox& box, double spacing_m) {
  std::vector<GridPoint> points;
  bool eastward = true;
  for (double north = box.min.north_m; north <= box.max.north_m; north += spacing_m) {
    const double from = eastward ? box.min.east_m : box.max.east_m;
    const double to = eastward ? box.max.east_m : box.min.east_m;
    points.push_back({from, north});
    points.push_back({to, north});
    eastward = !eastward;
  }
  return points;
}

}  // namespace roadfix::fly
