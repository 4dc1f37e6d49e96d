// Imagery that lies on the plane of a UTM zone, and what a UAV above it would see.
#pragma once

#include <array>

#include "core/detect/road_detector.hpp"
#include "core/units/planar.hpp"

namespace roadfix {

/// North-up imagery: pixel (0, 0) has its outer corner at `north_west`, rows run south.
struct Orthoimage {
  GroundImage image;
  GridPoint north_west;

  GridBox box() const;
};

/// From the pixel in which the box begins at its north-western corner up to that in which it ends, without that one.
/// It shares the memory of the imagery, and is empty where they do not meet.
Orthoimage part_within(const Orthoimage& imagery, const GridBox& box);

/// Whether the imagery holds an observed pixel there.
bool sees(const Orthoimage& imagery, GridPoint point);

/// A rectangle on the ground in the body frame: width across, height along the direction of travel.
struct Footprint {
  double width_m = 0.0;
  double height_m = 0.0;
};

/// Corners of the footprint placed at the pose: front left, front right, back right, back left.
std::array<GridPoint, 4> corners(const Footprint& footprint, const GridPose& pose);

/// The ground under the footprint as a picture in the body frame (row 0 = forward edge), pose at its centre.
/// Pixels beyond the imagery are unobserved.
GroundImage cut_out(const Orthoimage& imagery, const GridPose& pose, const Footprint& footprint, double gsd_m);

}  // namespace roadfix
