// One flight: what was true at each step and what the vehicle told of it.
//
// A flight knows no filter, so that several filters can be asked about the very same frames.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "cli/fly/pilot.hpp"
#include "cli/fly/sensor.hpp"
#include "cli/fly/vehicle.hpp"
#include "core/track/tracker.hpp"
#include "core/units/index_range.hpp"

namespace roadfix::fly {

struct Kidnapping {
  int step = 0;
  double distance_m = 0.0;  ///< by which the vehicle is somewhere else, unnoticed by its odometry
};

/// A vehicle that keeps its height above the sea over ground that is not level: what it sees is as large as its height
/// above the ground there makes it, and displaced by the relief of the ground.
struct LevelFlight {
  std::shared_ptr<const Terrain> terrain;  ///< never nullptr
  double above_sea_m = 0.0;
  double agl_m = 0.0;   ///< from which a frame shows as much ground as the sensor says, and which frames are made for
  bool is_told = true;  ///< that height above the sea; else the vehicle is said to be agl_m above ground

  std::optional<double> told_m() const { return is_told ? std::optional(above_sea_m) : std::nullopt; }
};

struct FlightPlan {
  int steps = 100;  ///< at most; a plan of waypoints may end before
  Handling handling;
  OdometryErrors odometry;
  bool tells_odometry = true;
  int frame_every = 1;               ///< a frame in every k-th step
  double missing_share = 0.0;        ///< of the frames, at random
  std::optional<IndexRange> outage;  ///< steps without frames
  std::optional<Kidnapping> kidnapping;
  /// 1 sigma per axis by which all that is seen lies elsewhere than on the map, once for the flight: what a map that is
  /// told to be so far off may do. Of no use where imagery has an error of its own.
  double registration_m = 0.0;
  /// 1 sigma of the relative error of the altitude, once for the flight: so much larger is all ground that is seen than
  /// the vehicle takes it to be. Recorded frames are as they are.
  double altitude_bias = 0.0;
  std::optional<LevelFlight> level;
};

/// What the vehicle tells at a step.
struct Report : StepInput {
  FrameSource frame;  ///< in place of features, where the detector is elsewhere

  bool saw() const { return features.has_value() || frame != nullptr; }
};

struct FlightStep {
  GridPose truth;
  Report input;
};

using Flight = std::vector<FlightStep>;

/// Streams of a flight's seed: what is drawn for the motion, and for the camera at each step.
evaluation::Random motion_stream(std::uint64_t seed);
evaluation::Random camera_stream(std::uint64_t seed, int step);

/// Whether the plan has a frame at this step, some of them lost at random.
bool frame_comes(const FlightPlan& plan, int step, evaluation::Random& random);

/// How many steps a pilot takes to the end of its course, at most those of the plan, kidnapped nowhere.
int steps_to_the_end(const FlightPlan& plan, Pilot& pilot, std::uint64_t seed);

/// Equal arguments give equal flights; what the steps see does not depend on the other steps. `seen` is called after
/// each step. Throws InvalidInput "no-place-to-fly", "kidnapping-too-far".
Flight fly(const FlightPlan& plan, const GridBox& box, Pilot& pilot, const Sensor& sensor, std::uint64_t seed,
           const std::function<void()>& seen);

}  // namespace roadfix::fly
