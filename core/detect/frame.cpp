#include "core/detect/frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/detect/blank_ground.hpp"
#include "core/detect/painted_border.hpp"
#include "core/units/error.hpp"

namespace roadfix {

double farthest_ground_m(const FrameCamera& camera) {
  constexpr double kFarthestM = 3000.0;
  constexpr double kFarthestHeights = 5.0;  // farther away the angle is too flat to see roads
  constexpr double kSeenByAll = 1.5;        // heights: the corners of what wide lenses see straight below
  constexpr double kMostMovedM = 10.0;      // about as wide as streets
  const double agl_m = camera.agl_m;
  const Angle sigma = camera.attitude_sigma.value_or(kToldAttitudeSigma);
  const double moved_m = std::sqrt(kMostMovedM * agl_m / sigma.radians());
  return std::min(kFarthestM, std::clamp(moved_m, kSeenByAll * agl_m, kFarthestHeights * agl_m));
}

void require_roads_visible(double gsd_m) {
  if (gsd_m < kFinestGsdM) {
    throw InvalidInput("frame-too-fine",
                       fmt::format("frame: pixels of {:.6g} m are too fine, at least {} m is needed: check the metres "
                                   "per pixel, or the field of view and the altitude",
                                   gsd_m, kFinestGsdM));
  }
  if (gsd_m <= kCoarsestGsdM) return;
  throw InvalidInput("frame-too-coarse",
                     fmt::format("frame: pixels of {:.6g} m are too coarse to show roads, at most {} m is allowed: "
                                 "check the metres per pixel, or the field of view and the altitude",
                                 gsd_m, kCoarsestGsdM));
}

GroundView ground_seen(FramePixels frame, const FrameView& view, const RoadDetector& detector, double max_pixels) {
  const double nominal_m = nominal_gsd_m(view, frame.pixels.size());
  require_roads_visible(nominal_m);
  exclude_painted_border(frame);
  GroundView seen;
  if (const auto* camera = std::get_if<FrameCamera>(&view)) {
    const double gsd_m = std::max(nominal_m, 0.5 * detector.preferred_gsd_m());
    seen = rectify(frame.pixels, frame.observed, *camera, {gsd_m, farthest_ground_m(*camera), max_pixels});
  } else {
    seen = vertical_view({std::move(frame.pixels), std::move(frame.observed), nominal_m});
  }
  exclude_blank(seen.image);
  return seen;
}

FeatureMap detect_features(const RoadDetector& detector, const GroundView& view, double cell_m, std::uint64_t seed,
                           const std::stop_token& stop) {
  const double cells_per_px = view.image.gsd_m / cell_m;
  return {detector.detect(view.image, cell_m, seed, stop),
          cell_m,
          {view.nadir_px.x * cells_per_px, view.nadir_px.y * cells_per_px},
          view.nadir_sigma_m,
          view.nadir_heading_sigma};
}

GroundView vertical_view(GroundImage image) {
  const cv::Point2d centre(image.pixels.cols / 2.0, image.pixels.rows / 2.0);
  return {std::move(image), centre};
}

}  // namespace roadfix
