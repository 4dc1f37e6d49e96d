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

/// How far from the nadir point ground is looked at. An attitude that is off by `a` moves what lies d from there by
/// a d^2 / h more than the ground below: far ground would contradict near ground. So as far as an error of the attitude
/// (FrameCamera::attitude_sigma, else kToldAttitudeSigma) moves it by 10 m: 1.5 to 5 times the camera's height, and 3
/// km at most. Nobody tells the attitude of cameras that are meant to look down, which see little beyond 1.5 heights:
/// they are looked at no less far than where it is told.
double farthest_ground_m(const FrameCamera& camera);

/// The ground that the frame shows. Frames of a camera are rectified in pixels as fine as the detector can use, as far
/// as farthest_ground_m(). A painted border (painted_border.hpp) and blank areas (blank_ground.hpp) count as not seen.
/// Throws what rectify() and require_roads_visible() do.
GroundView ground_seen(FramePixels frame, const FrameView& view, const RoadDetector& detector, double max_pixels);

/// The view's roads in cells of `cell_m`. Throws what RoadDetector::detect does.
FeatureMap detect_features(const RoadDetector& detector, const GroundView& view, double cell_m, std::uint64_t seed,
                           const std::stop_token& stop = {});

/// The view of a picture taken straight down, with the nadir in its middle.
GroundView vertical_view(GroundImage image);

}  // namespace roadfix
