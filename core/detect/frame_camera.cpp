#include "core/detect/frame_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

void require_camera(bool condition, const char* field, const char* range) {
  if (!condition) throw InvalidInput("frame-camera", fmt::format("frame: {} must lie in {}", field, range));
}

/// A frame that was scaled or cropped has another principal point than its calibration, mostly far from the centre.
void require_in_the_middle(cv::Point2d principal_px, cv::Size frame) {
  const auto far = [](double at, int side) { return !(std::abs(at / side - 0.5) <= 0.25); };
  if (!far(principal_px.x, frame.width) && !far(principal_px.y, frame.height)) return;
  throw InvalidInput("frame-camera",
                     fmt::format("frame: principal_px ({}, {}) is not in the middle half of {} x {} pixels: give focal "
                                 "length, principal point and distortion for frames of this size",
                                 principal_px.x, principal_px.y, frame.width, frame.height));
}

/// Cosine of the angle between the optical axis and straight down.
double down(const FrameCamera& camera) { return level_from_camera(camera)(2, 2); }

/// The same, but no less than for the flattest view.
double steepness(const FrameCamera& camera) { return std::max(down(camera), cos(kFlattestView)); }

/// The tangent of that angle: the distance from the nadir to the ground on the optical axis, in heights.
double lean(const FrameCamera& camera) {
  const double steep = steepness(camera);
  return std::sqrt(1.0 - steep * steep) / steep;
}

}  // namespace

void validate(const FrameCamera& camera, cv::Size frame) {
  if (camera.horizontal_fov.has_value() == camera.focal_px.has_value()) {
    throw InvalidInput("frame-camera", "frame: give either the field of view or the focal length");
  }
  require_camera(
      !camera.horizontal_fov || (camera.horizontal_fov->degrees() > 0.0 && camera.horizontal_fov->degrees() < 180.0),
      "fov_deg", "(0, 180) degrees");
  require_camera(!camera.focal_px || (*camera.focal_px > 0.0 && *camera.focal_px < 1e9), "focal_px", "(0, 1e9) pixels");
  require_camera(camera.agl_m > 0.0 && camera.agl_m <= kHighestAglM, "agl_m", "(0, 20000] metres");
  require_camera(std::abs(camera.assumed_roll().degrees()) <= 180.0, "roll_deg", "[-180, 180] degrees");
  require_camera(std::abs(camera.assumed_pitch().degrees()) <= 180.0, "pitch_deg", "[-180, 180] degrees");
  require_camera(
      !camera.attitude_sigma || (*camera.attitude_sigma > Angle() && *camera.attitude_sigma <= kLargestAttitudeSigma),
      "attitude_sigma_deg", "(0, 20] degrees");
  const bool calibrated = camera.principal_px || camera.lens != LensModel::kPerspective || !camera.distortion.empty();
  if (calibrated && !camera.focal_px) {
    throw InvalidInput(
        "frame-camera",
        "frame: principal point, distortion and a fisheye lens come from a calibration: give its focal length "
        "in pixels with them, not the field of view");
  }
  if (camera.principal_px) require_in_the_middle(*camera.principal_px, frame);
}

Lens lens_of(const FrameCamera& camera, cv::Size frame) {
  const double focal_px =
      camera.focal_px ? *camera.focal_px : frame.width / 2.0 / std::tan(camera.horizontal_fov->radians() / 2.0);
  const cv::Point2d principal = camera.principal_px ? *camera.principal_px + cv::Point2d(0.5, 0.5)
                                                    : cv::Point2d(frame.width / 2.0, frame.height / 2.0);
  return {focal_px, principal, camera.lens, camera.distortion};
}

cv::Matx33d level_from_camera(const FrameCamera& camera) {
  const double cp = cos(camera.assumed_pitch());
  const double sp = sin(camera.assumed_pitch());
  const double cr = cos(camera.assumed_roll());
  const double sr = sin(camera.assumed_roll());
  // Pitch about the right axis: the optical axis swings forward (-y). Roll about the forward axis: it swings left (-x).
  const cv::Matx33d pitch(1, 0, 0, 0, cp, -sp, 0, sp, cp);
  const cv::Matx33d roll(cr, 0, -sr, 0, 1, 0, sr, 0, cr);
  return pitch * roll;
}

std::optional<cv::Point2d> ground_of(const FrameCamera& camera, cv::Point2d ray) {
  const cv::Vec3d level = level_from_camera(camera) * cv::Vec3d(ray.x, ray.y, 1.0);
  if (level[2] <= 1e-6) return std::nullopt;
  return cv::Point2d(level[0], level[1]) * (camera.agl_m / level[2]);
}

bool looks_down(const FrameCamera& camera) { return down(camera) >= cos(kFlattestView); }

/// Angles of gimbals and autopilots that call straight down -90 degrees would look at the horizon.
void require_looking_down(const FrameCamera& camera) {
  if (looks_down(camera)) return;
  throw InvalidInput(
      "frame-sees-no-ground",
      fmt::format(
          "frame: with a roll of {:.1f} and a pitch of {:.1f} degrees the camera looks at the horizon or the sky; "
          "both are measured from straight down: the -90 of a gimbal is a pitch of 0",
          camera.assumed_roll().degrees(), camera.assumed_pitch().degrees()));
}

double nominal_gsd_m(const FrameView& view, cv::Size frame) {
  if (const auto* straight = std::get_if<StraightDown>(&view)) return straight->gsd_m;
  const auto& camera = std::get<FrameCamera>(view);
  validate(camera, frame);
  return camera.agl_m / lens_of(camera, frame).focal_px();
}

Angle attitude_sigma(const FrameCamera& camera) {
  if (camera.attitude_sigma) return *camera.attitude_sigma;
  return camera.roll && camera.pitch ? kToldAttitudeSigma : kUntoldAttitudeSigma;
}

double nadir_sigma_m(const FrameCamera& camera) {
  const double steep = steepness(camera);
  const double turned = attitude_sigma(camera).radians() / (steep * steep);
  return camera.agl_m * std::hypot(turned, kHeightSigma * lean(camera));
}

Angle nadir_heading_sigma(const FrameCamera& camera) {
  const double sigma = attitude_sigma(camera).radians();
  // The lean is known no better than the attitude, whose error has two axes.
  const double turned = sigma * std::hypot(lean(camera), std::numbers::sqrt2 * sigma) / std::numbers::sqrt2;
  return Angle::radians(std::hypot(turned, kTurnOfScale * kHeightSigma));
}

}  // namespace roadfix
