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

}  // namespace roadfix::world
