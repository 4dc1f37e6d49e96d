// Sun, air, season and camera of the day on which a picture is taken.
#pragma once

#include <cmath>

#include "core/units/angle.hpp"
#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world {

struct Conditions {
  Angle sun_azimuth;           ///< clockwise from grid north, where the sun stands
  Angle sun_elevation;         ///< above the horizon
  PlanPoint lean;              ///< where tops of things appear: metres on the plan for each metre of height
  double dust = 0.0;           ///< share of dust on streets and roofs
  double asphalt = 1.0;        ///< brightness of the streets against the palette's
  double haze = 0.0;           ///< share of scattered light, more where buildings fell
  double winter = 0.0;         ///< 0 summer, 1 brown grass and bare trees
  double contrast = 1.0;       ///< factor on what a brightness differs from a middle grey
  Colour gain{1.0, 1.0, 1.0};  ///< factors on red, green and blue after that
  double blur_px = 0.6;        ///< 1 sigma
  double noise = 2.0;          ///< of the sensor, 1 sigma in grey levels
  int noise_stream = 1;        ///< pictures of different ones have different noise

  /// Unit vector on the plan from the sun onwards, the way shadows fall.
  PlanPoint shadow_direction() const { return {-std::sin(sun_azimuth.radians()), std::cos(sun_azimuth.radians())}; }
  /// Metres of shadow of a thing one metre high.
  double shadow_length() const { return 1.0 / std::tan(sun_elevation.radians()); }
};

/// A clear summer morning; a hazy winter day with a low sun and a camera that looks from the side.
Conditions summer_before();
Conditions winter_after();

/// Any sun, air, season, street surface and camera: pictures to learn from must not all be of two days.
Conditions any_day(Random& random, int noise_stream);

}  // namespace roadfix::world
