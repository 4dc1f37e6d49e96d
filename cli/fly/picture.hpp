// Pictures of a flight as in figures 3 and 4 of the paper: the ground, particles, the true pose with the camera's
// window, the estimate with its ellipse, and the circle that holds 95 %.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "cli/fly/localizer.hpp"
#include "core/detect/orthoimage.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix::fly {

/// The ground from above, north up.
struct Backdrop {
  cv::Mat pixels;  ///< CV_8UC3
  GridBox box;
  double gsd_m = 1.0;

  cv::Point2d at(GridPoint point) const {
    return {(point.east_m - box.min.east_m) / gsd_m, (box.max.north_m - point.north_m) / gsd_m};
  }
};

/// The map's extent with roads in grey, and the imagery (null = none) where it shows something.
Backdrop backdrop_of(const MapView& map, const Orthoimage* imagery, int longest_px);

struct Scene {
  std::string caption;
  const Record* record = nullptr;
  std::vector<GridPoint> path;  ///< the true places so far
  std::vector<GridPose> particles;
  Footprint footprint;
};

/// Particles are orange, the truth with its path and window is green, the estimate with its 95 % ellipse red, the
/// circle that holds the vehicle with 95 % blue.
cv::Mat drawn(const Backdrop& backdrop, const UtmZone& zone, const Scene& scene);

}  // namespace roadfix::fly
