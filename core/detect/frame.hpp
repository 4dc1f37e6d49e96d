// From a camera frame to the ground it shows: a metric picture in the body frame.
//
// Pinhole camera looking down, without lens distortion. Body axes: x forward, y right, z down. With roll and pitch of
// zero the optical axis points straight down and the top row of the frame is the forward edge. Pitch turns the nose up,
// roll the right side down (aerospace convention): a positive pitch moves the seen ground forward, a positive roll to
// the left. The ground is taken as flat.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "core/detect/road_detector.hpp"
#include "core/grid/feature_map.hpp"
#include "core/units/angle.hpp"

namespace roadfix {

/// What is known about the camera when the frame was taken.
struct FrameCamera {
  /// One of the two: field of view across the columns, in (0, 180) degrees, or focal length in pixels.
  std::optional<Angle> horizontal_fov;
  std::optional<double> focal_px;
  double agl_m = 0.0;  ///< altitude above ground, in (0, 20000]
  Angle roll;
  Angle pitch;
};

struct GroundView {
  GroundImage image;
  cv::Point2d nadir_px;  ///< the point below the UAV in continuous pixels ((0, 0) = outer corner), may lie outside
};

/// Throws InvalidInput ("frame-camera") that names the field and its range.
void validate(const FrameCamera& camera);

/// How well the point below the UAV is known among what the frame shows, 1 sigma per axis in metres, where roll and
/// pitch are known to `attitude`: that many times the height, more in oblique views.
double nadir_sigma_m(const FrameCamera& camera, Angle attitude);

/// What is expected of a gimbal or an autopilot that says nothing of its own attitude.
inline constexpr Angle kAttitudeSigma = Angle::degrees(1.0);

/// Where on the ground a pixel (continuous, (0, 0) = outer corner of a frame of `size`) looks: metres right and *back*
/// of the nadir point. nullopt at and above the horizon.
std::optional<cv::Point2d> ground_of(const FrameCamera& camera, cv::Size size, cv::Point2d pixel);

/// The part of the ground the frame shows, at most `max_range_m` from the nadir point (beyond it a tilted view is all
/// blur); pixels outside the frame are unobserved. `max_pixels` bounds the result: LimitExceeded ("ground-too-large").
/// `frame_observed` (CV_8UC1, may be empty = all) marks the frame's own observed pixels.
GroundView rectify(const cv::Mat& frame, const cv::Mat& frame_observed, const FrameCamera& camera, double gsd_m,
                   double max_range_m, double max_pixels);

/// Pixels wider than most roads do not show them, and a picture of such pixels is mostly a mistaken number.
inline constexpr double kCoarsestGsdM = 5.0;
/// Finer ones are a mistaken number as well: a large frame of them shows less than a road is wide, and detectors need
/// room for a whole pixel of their own around it.
inline constexpr double kFinestGsdM = 0.001;
/// Throws InvalidInput ("frame-too-coarse", "frame-too-fine") beyond these.
void require_roads_visible(double gsd_m);

/// Ground sample distance straight below the UAV with the camera level.
double nominal_gsd_m(const FrameCamera& camera, cv::Size size);

/// rectify() up to 3 km from the nadir point, farther than which ground is seen too flat to tell a road, in pixels that
/// the detector makes use of. What frame.gsd_m says is not looked at. Throws "frame-too-coarse" and "frame-too-fine"
/// too.
GroundView ground_seen(const GroundImage& frame, const FrameCamera& camera, const RoadDetector& detector,
                       double max_pixels);

/// The view's roads in cells of `cell_m`. Throws what RoadDetector::detect does.
FeatureMap detect_features(const RoadDetector& detector, const GroundView& view, double cell_m, std::uint64_t seed,
                           const std::stop_token& stop = {});

/// A frame that is already a metric picture of the ground, seen straight from above.
GroundView rectified(GroundImage image);

}  // namespace roadfix
