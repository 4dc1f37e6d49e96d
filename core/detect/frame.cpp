#include "core/detect/frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

const Angle kFlattestView = Angle::degrees(80.0);

void require_camera(bool condition, const char* field, const char* range) {
  if (!condition) throw InvalidInput("frame-camera", fmt::format("frame: {} must lie in {}", field, range));
}

double focal_px(const FrameCamera& camera, cv::Size size) {
  return camera.focal_px ? *camera.focal_px : size.width / 2.0 / std::tan(camera.horizontal_fov->radians() / 2.0);
}

/// Rotation from camera axes (x right, y back, z down the optical axis) to the level frame (x right, y back, z down).
cv::Matx33d level_from_camera(const FrameCamera& camera) {
  const double cp = cos(camera.pitch);
  const double sp = sin(camera.pitch);
  const double cr = cos(camera.roll);
  const double sr = sin(camera.roll);
  // Pitch about the right axis: the optical axis swings forward (-y). Roll about the forward axis: it swings left (-x).
  const cv::Matx33d pitch(1, 0, 0, 0, cp, -sp, 0, sp, cp);
  const cv::Matx33d roll(cr, 0, -sr, 0, 1, 0, sr, 0, cr);
  return pitch * roll;
}

/// Homography from ground metres (right, back) to continuous frame pixels.
cv::Matx33d pixel_from_ground(const FrameCamera& camera, cv::Size size) {
  const double f = focal_px(camera, size);
  const cv::Matx33d intrinsics(f, 0, size.width / 2.0, 0, f, size.height / 2.0, 0, 0, 1);
  const cv::Matx33d plane(1, 0, 0, 0, 1, 0, 0, 0, camera.agl_m);  // (right, back, 1) -> point on the ground
  return intrinsics * level_from_camera(camera).t() * plane;
}

/// Cosine of the angle between the optical axis and straight down.
double down(const FrameCamera& camera) { return (level_from_camera(camera) * cv::Vec3d(0.0, 0.0, 1.0))[2]; }

/// Gimbals and autopilots that call straight down -90 degrees would be taken at their word and look at the horizon.
void require_looking_down(const FrameCamera& camera) {
  if (down(camera) >= cos(kFlattestView)) return;
  throw InvalidInput(
      "frame-sees-no-ground",
      fmt::format(
          "frame: with a roll of {:.1f} and a pitch of {:.1f} degrees the camera looks at the horizon or the sky; "
          "both are measured from straight down: the -90 of a gimbal is a pitch of 0",
          camera.roll.degrees(), camera.pitch.degrees()));
}

/// Box of the seen ground within the range, in metres (x right, y back).
cv::Rect2d seen_ground(const FrameCamera& camera, cv::Size size, double max_range_m) {
  constexpr int kSteps = 32;
  cv::Point2d low(max_range_m, max_range_m);
  cv::Point2d high(-max_range_m, -max_range_m);
  bool any = false;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      auto ground = ground_of(
          camera, size, {size.width * i / static_cast<double>(kSteps), size.height * j / static_cast<double>(kSteps)});
      if (!ground) continue;
      any = any || cv::norm(*ground) <= max_range_m;
      ground->x = std::clamp(ground->x, -max_range_m, max_range_m);
      ground->y = std::clamp(ground->y, -max_range_m, max_range_m);
      low = {std::min(low.x, ground->x), std::min(low.y, ground->y)};
      high = {std::max(high.x, ground->x), std::max(high.y, ground->y)};
    }
  }
  if (!any) {
    throw InvalidInput(
        "frame-sees-no-ground",
        fmt::format(
            "frame: with a roll of {:.1f} and a pitch of {:.1f} degrees the frame shows no ground within {:.0f} m",
            camera.roll.degrees(), camera.pitch.degrees(), max_range_m));
  }
  return {low, high};
}

}  // namespace

void validate(const FrameCamera& camera) {
  require_camera(camera.horizontal_fov.has_value() != camera.focal_px.has_value(),
                 "one of field of view and focal length", "use");
  require_camera(
      !camera.horizontal_fov || (camera.horizontal_fov->degrees() > 0.0 && camera.horizontal_fov->degrees() < 180.0),
      "fov_deg", "(0, 180) degrees");
  require_camera(!camera.focal_px || (*camera.focal_px > 0.0 && *camera.focal_px < 1e9), "focal_px", "(0, 1e9) pixels");
  require_camera(camera.agl_m > 0.0 && camera.agl_m <= 20'000.0, "agl_m", "(0, 20000] metres");
  require_camera(std::abs(camera.roll.degrees()) <= 180.0, "roll_deg", "[-180, 180] degrees");
  require_camera(std::abs(camera.pitch.degrees()) <= 180.0, "pitch_deg", "[-180, 180] degrees");
}

double nadir_sigma_m(const FrameCamera& camera, Angle attitude) {
  // The ground on the optical axis is agl tan(angle) from the nadir.
  const double steepness = std::max(down(camera), cos(kFlattestView));
  return camera.agl_m * attitude.radians() / (steepness * steepness);
}

std::optional<cv::Point2d> ground_of(const FrameCamera& camera, cv::Size size, cv::Point2d pixel) {
  const double f = focal_px(camera, size);
  const cv::Vec3d ray =
      level_from_camera(camera) * cv::Vec3d((pixel.x - size.width / 2.0) / f, (pixel.y - size.height / 2.0) / f, 1.0);
  if (ray[2] <= 1e-6) return std::nullopt;
  return cv::Point2d(ray[0], ray[1]) * (camera.agl_m / ray[2]);
}

GroundView rectify(const cv::Mat& frame, const cv::Mat& frame_observed, const FrameCamera& camera, double gsd_m,
                   double max_range_m, double max_pixels) {
  validate(camera);
  require_looking_down(camera);
  require_camera(gsd_m > 0.0 && gsd_m < 1e6, "gsd_m", "(0, 1e6) metres");
  const cv::Rect2d box = seen_ground(camera, frame.size(), max_range_m);
  const double cols = std::ceil(box.width / gsd_m);
  const double rows = std::ceil(box.height / gsd_m);
  if (!(cols * rows <= max_pixels)) {
    throw LimitExceeded(
        "ground-too-large",
        fmt::format(
            "frame: it shows {:.0f} x {:.0f} m, {:.0f} pixels at {} m; at most {:.0f} are allowed: use a coarser "
            "ground sample distance or a shorter range",
            box.width, box.height, cols * rows, gsd_m, max_pixels));
  }
  const cv::Size size(std::max(1, static_cast<int>(cols)), std::max(1, static_cast<int>(rows)));
  // OpenCV puts integers at pixel centres: half a pixel in, half a pixel out.
  const cv::Matx33d ground_from_target(gsd_m, 0, box.x + 0.5 * gsd_m, 0, gsd_m, box.y + 0.5 * gsd_m, 0, 0, 1);
  const cv::Matx33d centred(1, 0, -0.5, 0, 1, -0.5, 0, 0, 1);
  const cv::Matx33d frame_from_target = centred * pixel_from_ground(camera, frame.size()) * ground_from_target;
  GroundView view;
  view.image.gsd_m = gsd_m;
  view.nadir_px = {-box.x / gsd_m, -box.y / gsd_m};
  cv::warpPerspective(frame, view.image.pixels, frame_from_target, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                      cv::BORDER_REPLICATE);
  const cv::Mat seen = frame_observed.empty() ? cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255)) : frame_observed;
  cv::warpPerspective(seen, view.image.observed, frame_from_target, size, cv::INTER_NEAREST | cv::WARP_INVERSE_MAP,
                      cv::BORDER_CONSTANT, cv::Scalar(0));
  // A homography also maps what lies behind the camera into the frame: only ground in front and in range was seen.
  const cv::Matx33d camera_from_level = level_from_camera(camera).t();
  for (int row = 0; row < size.height; ++row) {
    for (int col = 0; col < size.width; ++col) {
      const cv::Vec3d ground = ground_from_target * cv::Vec3d(col, row, 1.0);
      const cv::Vec3d ray = camera_from_level * cv::Vec3d(ground[0], ground[1], camera.agl_m);
      if (ray[2] <= 0.0 || std::hypot(ground[0], ground[1]) > max_range_m) view.image.observed.at<uchar>(row, col) = 0;
    }
  }
  return view;
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

double nominal_gsd_m(const FrameCamera& camera, cv::Size size) {
  validate(camera);
  return camera.agl_m / focal_px(camera, size);
}

GroundView ground_seen(const GroundImage& frame, const FrameCamera& camera, const RoadDetector& detector,
                       double max_pixels) {
  constexpr double kFarthestGroundM = 3000.0;
  const double nominal_m = nominal_gsd_m(camera, frame.pixels.size());
  require_roads_visible(nominal_m);
  const double gsd_m = std::max(nominal_m, 0.5 * detector.preferred_gsd_m());
  return rectify(frame.pixels, frame.observed, camera, gsd_m, kFarthestGroundM, max_pixels);
}

FeatureMap detect_features(const RoadDetector& detector, const GroundView& view, double cell_m, std::uint64_t seed,
                           const std::stop_token& stop) {
  const double cells_per_px = view.image.gsd_m / cell_m;
  return {detector.detect(view.image, cell_m, seed, stop),
          cell_m,
          {view.nadir_px.x * cells_per_px, view.nadir_px.y * cells_per_px}};
}

GroundView rectified(GroundImage image) {
  const cv::Point2d centre(image.pixels.cols / 2.0, image.pixels.rows / 2.0);
  return {std::move(image), centre};
}

}  // namespace roadfix
