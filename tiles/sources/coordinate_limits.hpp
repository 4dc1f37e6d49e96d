// Which coordinates can be those of a place on the Earth: files hold others by accident, and one of them is enough to
// spoil the box around all.
#pragma once

#include <ogrsf_frmts.h>

#include <string>

namespace roadfix {

/// On either side of zero, in the units of a reference system; for its coordinates with x east or longitude first.
struct CoordinateLimits {
  double x = 0.0;
  double y = 0.0;

  bool hold(const OGREnvelope& box) const;
  /// Whether they hold all corners of its lines and areas. A coordinate that is no number is beyond all limits.
  bool hold(const OGRGeometry& geometry) const;
};

/// A turn and a quarter of one for longitudes and latitudes. The plane of a projection ends for each elsewhere: far
/// beyond all of them.
CoordinateLimits coordinate_limits(const OGRSpatialReference& crs);

/// Throws InvalidInput "degrees-as-metres" where the coordinates of a projected reference system could all be
/// longitudes and latitudes.
void refuse_degrees_as_metres(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path);

/// Throws InvalidInput "axes-swapped" where the middle of the box lies farther from the area that a projected reference
/// system is meant for than that is wide or high, and with x and y swapped would lie in it.
void refuse_swapped_axes(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path);

}  // namespace roadfix
