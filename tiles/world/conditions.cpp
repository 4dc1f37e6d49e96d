#include "tiles/world/conditions.hpp"

namespace roadfix::world {

Conditions summer_before() {
  return {.sun_azimuth = Angle::degrees(138.0),
          .sun_elevation = Angle::degrees(62.0),
          .lean = {0.04, -0.07},
          .dust = 0.12,
          .haze = 0.03,
          .winter = 0.0,
          .contrast = 1.0,
          .gain = {1.0, 1.0, 1.0},
          .blur_px = 0.75,
          .noise = 2.0,
          .noise_stream = 1};
}

Conditions winter_after() {
  return {.sun_azimuth = Angle::degrees(158.0),
          .sun_elevation = Angle::degrees(32.0),
          .lean = {-0.20, 0.16},
          .dust = 0.42,
          .haze = 0.09,
          .winter = 1.0,
          .contrast = 1.06,
          .gain = {0.95, 0.94, 0.93},
          .blur_px = 0.95,
          .noise = 3.2,
          .noise_stream = 5};
}

Conditions any_day(Random& random, int noise_stream) {
  const double side = random.uniform(0.0, 0.3);
  const Angle towards = Angle::degrees(random.uniform(0.0, 360.0));
  Conditions day{.sun_azimuth = Angle::degrees(random.uniform(0.0, 360.0)),
                 .sun_elevation = Angle::degrees(random.uniform(20.0, 70.0)),
                 .lean = {side * std::cos(towards.radians()), side * std::sin(towards.radians())},
                 .dust = random.uniform(0.0, 0.6),
                 .asphalt = random.uniform(0.65, 1.35),
                 .haze = random.uniform(0.0, 0.2),
                 .winter = random.unit(),
                 .contrast = random.uniform(0.85, 1.15)};
  for (int i = 0; i < 3; ++i) day.gain[i] = random.uniform(0.88, 1.08);
  day.blur_px = random.uniform(0.5, 1.3);
  day.noise = random.uniform(1.0, 5.0);
  day.noise_stream = noise_stream;
  return day;
}

}  // namespace roadfix::world
