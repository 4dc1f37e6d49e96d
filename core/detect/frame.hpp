// From a frame, with or without a camera, to the ground it shows and the roads on it.
#pragma once

#include <cstdint>
#include <stop_token>

#include "core/detect/frame_camera.hpp"
#include "core/detect/frame_image.hpp"
#include "core/detect/rectify.hpp"
#include "core/detect/road_detector.hpp"
#include "core/grid/feature_map.hpp"

namespace roadfix {

/// Pixels wider than most roads do not show them, and a picture of such pixels is mostly a mistaken number.
inline constexpr double kCoarsestGsdM = 5.0;
/// Finer ones are a mistaken number as well: a large frame of them shows less than a road is wide, and detectors need
/// room for a whole pixel of their own around it.
inline constexpr double kFinestGsdM = 0.001;
/// Throws InvalidInput ("frame-too-coarse", "frame-too-fine") beyond these.
void require_roads_visible(double gsd_m);

/// What the frame shows of the ground. Of a camera: rectify() up to five times its height from the nadir point, and
/// 3 km, farther than which ground is seen too flat to tell a road, in pixels that the detector makes use of. A painted
/// border (painted_border.hpp) and blank areas (blank_ground.hpp) were not seen. Throws what rectify() and
/// require_roads_visible() do.
GroundView ground_seen(FramePixels frame, const FrameView& view, const RoadDetector& detector, double max_pixels);

/// The view's roads in cells of `cell_m`. Throws what RoadDetector::detect does.
FeatureMap detect_features(const RoadDetector& detector, const GroundView& view, double cell_m, std::uint64_t seed,
                           const std::stop_token& stop = {});

/// A frame that is already a metric picture of the ground, seen straight from above.
GroundView rectified(GroundImage image);

}  // namespace roadfix
