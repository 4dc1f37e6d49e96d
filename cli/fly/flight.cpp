#include "cli/fly/flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix::fly {
namespace {

using evaluation::Random;
using evaluation::stream;

constexpr int kTries = 10'000;

// Streams of a seed: the flight, and one for the camera of each step.
constexpr std::uint64_t kMotion = 0;
constexpr std::uint64_t kCamera = 1;
constexpr std::uint64_t kRegistration = 2;

GridPose first_pose(Pilot& pilot, const Sensor& sensor, Random& random) {
  for (int i = 0; i < kTries; ++i) {
    const GridPose pose = pilot.start(random);
    if (sensor.shows(pose.position)) return pose;
  }
  throw InvalidInput("no-place-to-fly",
                     "no start was found where the vehicle sees ground: check that imagery, map and waypoints overlap");
}

GridPose jumped(const GridPose& from, double distance_m, const GridBox& box, const Sensor& sensor, Random& random) {
  for (int i = 0; i < kTries; ++i) {
    const Angle direction = Angle::degrees(uniform(random, -180.0, 180.0));
    const GridPoint to{from.position.east_m + distance_m * sin(direction),
                       from.position.north_m + distance_m * cos(direction)};
    if (box.contains(to) && sensor.shows(to)) return {to, from.heading};
  }
  throw InvalidInput("kidnapping-too-far",
                     fmt::format("no place {} m away lies in the area: choose a shorter distance", distance_m));
}

class Sight {
 public:
  Sight(const FlightPlan& plan, const Sensor& sensor, std::uint64_t seed) : plan_(plan), sensor_(sensor), seed_(seed) {
    Random random = stream(seed, kRegistration, 0);
    off_ = {plan.registration_m * normal(random), plan.registration_m * normal(random)};
    scale_ = std::max(0.5, 1.0 + plan.altitude_bias * normal(random));
  }

  Observation at(int step, const GridPose& pose) const {
    Random random = camera_stream(seed_, step);
    const auto from = outlook(pose);
    if (!frame_comes(plan_, step, random) || !from) return {};
    return sensor_.observe(*from, random);
  }

 private:
  /// nullopt where the vehicle is not above ground of a known height.
  std::optional<Outlook> outlook(const GridPose& pose) const {
    Outlook from{{{pose.position.east_m + off_.east_m, pose.position.north_m + off_.north_m}, pose.heading}, scale_};
    if (!plan_.level) return from;
    const Terrain& terrain = *plan_.level->terrain;
    const auto agl_m = terrain.height_above_ground_m(pose.position, plan_.level->above_sea_m);
    if (!agl_m) return std::nullopt;
    from.scale *= *agl_m / plan_.level->agl_m;
    from.relief = Relief(terrain, pose, *agl_m);
    return from;
  }

  const FlightPlan& plan_;
  const Sensor& sensor_;
  std::uint64_t seed_;
  GridPoint off_;
  double scale_ = 1.0;
};

class ClosedEyes : public Sensor {
 public:
  Observation observe(const Outlook&, Random&) const override { return {}; }
  bool shows(GridPoint) const override { return true; }
};

}  // namespace

Random motion_stream(std::uint64_t seed) { return stream(seed, kMotion, 0); }

Random camera_stream(std::uint64_t seed, int step) { return stream(seed, kCamera, static_cast<std::uint64_t>(step)); }

bool frame_comes(const FlightPlan& plan, int step, Random& random) {
  const bool lost = uniform(random, 0.0, 1.0) < plan.missing_share;
  return !lost && step % plan.frame_every == 0 && !(plan.outage && plan.outage->contains(step));
}

int steps_to_the_end(const FlightPlan& plan, Pilot& pilot, std::uint64_t seed) {
  FlightPlan course = plan;
  course.kidnapping.reset();
  course.level.reset();
  return static_cast<int>(fly(course, {}, pilot, ClosedEyes(), seed, [] {}).size());
}

Flight fly(const FlightPlan& plan, const GridBox& box, Pilot& pilot, const Sensor& sensor, std::uint64_t seed,
           const std::function<void()>& seen) {
  Random random = motion_stream(seed);
  Vehicle vehicle(first_pose(pilot, sensor, random), plan.handling, plan.odometry, random);
  const Sight sight(plan, sensor, seed);
  Flight flight;
  for (int step = 0; step < plan.steps; ++step) {
    Report input;
    input.sequence = step;
    input.time_us = std::llround(1e6 * plan.handling.step_s * (step + 1));
    if (step > 0) {
      const std::optional<Angle> turn = pilot.steer(vehicle.pose(), random);
      if (!turn) break;
      const Odometry told = vehicle.move(*turn, random);
      if (plan.tells_odometry) input.odometry = told;
    }
    if (plan.kidnapping && plan.kidnapping->step == step) {
      vehicle.jump_to(jumped(vehicle.pose(), plan.kidnapping->distance_m, box, sensor, random));
    }
    Observation seen_now = sight.at(step, vehicle.pose());
    input.features = std::move(seen_now.features);
    input.frame = std::move(seen_now.frame);
    if (plan.level) input.altitude = Altitude{plan.level->told_m(), plan.level->agl_m};
    flight.push_back({vehicle.pose(), std::move(input)});
    seen();
  }
  return flight;
}

}  // namespace roadfix::fly
