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

/// Pixels wider than most roads do not show them; such a number is mostly a mistake.
inline constexpr double kCoarsestGsdM = 5.0;
/// Finer pixels are mostly a mistake as well: even a large frame of them would show less ground than a road is wide.
inline constexpr double kFinestGsdM = 0.001;
/// Throws InvalidInput ("frame-too-coarse", "frame-too-fine") beyond these.
void require_roads_visible(double gsd_m);

/// The ground that the frame shows. Frames of a camera are rectified in pixels as fine as the detector can use, as far
/// from the nadir point as an error of the attitude (FrameCamera::attitude_sigma, else kToldAttitudeSigma) moves ground
/// by no more than 10 m against that below: 1.5 to 5 times the camera's height, and 3 km at most. A painted border
/// (painted_border.hpp) and blank areas (blank_ground.hpp) count as not seen. Throws what rectify() and
/// require_roads_visible() do.
GroundView ground_seen(FramePixels frame, const FrameView& view, const RoadDetector& detector, double max_pixels);

/// The view's roads in cells of `cell_m`. Throws what RoadDetector::detect does.
FeatureMap detect_features(const RoadDetector& detector, const GroundView& view, double cell_m, std::uint64_t seed,
                           const std::stop_token& stop = {});

/// The view of a picture taken straight down, with the nadir in its middle.
GroundView vertical_view(GroundImage image);

}  // namespace roadfix
