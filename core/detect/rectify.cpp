#include "core/detect/rectify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "core/detect/ground_scale.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr int kLongestSidePx = 32'766;  // OpenCV warps no longer ones
constexpr int kStripRows = 256;  // rectified at a time: the table of source positions takes more memory than pixels do

const cv::Point2d kNowhere(-1e4, -1e4);  // outside any frame, even after it is scaled down

/// Box around the ground that is seen within the range, in metres (x right, y back).
cv::Rect2d seen_ground(const FrameCamera& camera, const Lens& lens, cv::Size size, double max_range_m) {
  constexpr int kSteps = 32;
  cv::Point2d low(max_range_m, max_range_m);
  cv::Point2d high(-max_range_m, -max_range_m);
  bool any = false;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const auto ray =
          lens.ray_of({size.width * i / static_cast<double>(kSteps), size.height * j / static_cast<double>(kSteps)});
      auto ground = ray ? ground_of(camera, *ray) : std::nullopt;
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
        fmt::format("frame: with a roll of {:.1f} and a pitch of {:.1f} degrees the frame shows no ground within "
                    "{:.0f} m of the point below, and what is farther off is placed too roughly: let the camera look "
                    "down more steeply",
                    camera.assumed_roll().degrees(), camera.assumed_pitch().degrees(), max_range_m));
  }
  return {low, high};
}

/// Size in pixels of the box. Throws LimitExceeded.
cv::Size size_of(const cv::Rect2d& box, double gsd_m, double max_pixels) {
  const double cols = std::ceil(box.width / gsd_m);
  const double rows = std::ceil(box.height / gsd_m);
  if (!(cols * rows <= max_pixels && std::max(cols, rows) <= kLongestSidePx)) {
    throw LimitExceeded(
        "ground-too-large",
        fmt::format(
            "frame: it shows {:.0f} x {:.0f} m, {:.0f} x {:.0f} pixels at {} m; at most {:.0f} are allowed, and "
            "{} along a side: use a coarser ground sample distance or a shorter range",
            box.width, box.height, cols, rows, gsd_m, max_pixels, kLongestSidePx));
  }
  return {std::max(1, static_cast<int>(cols)), std::max(1, static_cast<int>(rows))};
}

/// Where in the frame each pixel of the ground comes from.
class GroundToFrame {
 public:
  GroundToFrame(const FrameCamera& camera, Lens lens, cv::Point2d first_m, double gsd_m, double max_range_m)
      : lens_(std::move(lens)),
        camera_from_level_(level_from_camera(camera).t()),
        agl_m_(camera.agl_m),
        first_m_(first_m),
        gsd_m_(gsd_m),
        max_range_m_(max_range_m) {}

  /// In continuous pixels; kNowhere for ground that is out of range, behind the camera or beyond what its lens shows.
  std::vector<cv::Point2d> pixels_of(int row, int cols) const {
    std::vector<cv::Point2d> rays(static_cast<std::size_t>(cols));
    std::vector<bool> seen(rays.size());
    for (std::size_t col = 0; col < rays.size(); ++col) {
      const cv::Point2d ground = first_m_ + gsd_m_ * cv::Point2d(static_cast<double>(col) + 0.5, row + 0.5);
      const cv::Vec3d at = camera_from_level_ * cv::Vec3d(ground.x, ground.y, agl_m_);
      const cv::Point2d ray(at[0] / at[2], at[1] / at[2]);
      seen[col] = at[2] > 0.0 && ground.dot(ground) <= max_range_m_ * max_range_m_ && lens_.within(ray);
      if (seen[col]) rays[col] = ray;
    }
    std::vector<cv::Point2d> pixels = lens_.pixels_of(rays);
    for (std::size_t col = 0; col < pixels.size(); ++col) {
      if (!seen[col]) pixels[col] = kNowhere;
    }
    return pixels;
  }

 private:
  Lens lens_;
  cv::Matx33d camera_from_level_;
  double agl_m_;
  cv::Point2d first_m_;  ///< of the outer corner of the first pixel, right and back of the nadir
  double gsd_m_;
  double max_range_m_;
};

/// The frame, averaged so that its pixels are hardly finer than those of the ground on the optical axis: warping then
/// interpolates between the nearest four only.
GroundImage averaged(const cv::Mat& frame, const cv::Mat& observed, double finer) {
  const cv::Mat seen = observed.empty() ? cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255)) : observed;
  return at_gsd({frame, seen, 1.0}, std::max(1.0, std::floor(finer)));
}

void require_short_sides(cv::Size frame) {
  if (std::max(frame.width, frame.height) <= kLongestSidePx) return;
  throw LimitExceeded("image-too-large",
                      fmt::format("frame: {} x {} pixels cannot be rectified, with more than {} along a side: send it "
                                  "smaller, or a part of it",
                                  frame.width, frame.height, kLongestSidePx));
}

/// Fills these rows of the ground from `frame`, which is `scale` times as large as the original.
void warp_rows(const GroundImage& frame, cv::Point2d scale, const GroundToFrame& placed, cv::Range rows,
               GroundImage& ground) {
  cv::Mat places(rows.size(), ground.pixels.cols, CV_32FC2);
  for (int row = rows.start; row < rows.end; ++row) {
    const std::vector<cv::Point2d> pixels = placed.pixels_of(row, ground.pixels.cols);
    // OpenCV puts integers at pixel centres.
    std::ranges::transform(pixels, places.ptr<cv::Point2f>(row - rows.start), [&](cv::Point2d pixel) {
      return cv::Point2f(cv::Point2d(pixel.x * scale.x - 0.5, pixel.y * scale.y - 0.5));
    });
  }
  cv::Mat pixels = ground.pixels.rowRange(rows);
  cv::Mat observed = ground.observed.rowRange(rows);
  cv::remap(frame.pixels, pixels, places, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::remap(frame.observed, observed, places, {}, cv::INTER_NEAREST, cv::BORDER_CONSTANT, cv::Scalar(0));
}

}  // namespace

GroundView rectify(const cv::Mat& frame, const cv::Mat& frame_observed, const FrameCamera& camera,
                   const RectifiedGround& ground) {
  const auto [gsd_m, max_range_m, max_pixels] = ground;
  validate(camera, frame.size());
  require_looking_down(camera);
  if (!(gsd_m > 0.0 && gsd_m < 1e6)) throw InvalidInput("frame-camera", "frame: gsd_m must lie in (0, 1e6) metres");
  const Lens lens = lens_of(camera, frame.size());
  const cv::Rect2d box = seen_ground(camera, lens, frame.size(), max_range_m);
  const cv::Size size = size_of(box, gsd_m, max_pixels);
  const double axis_gsd_m = camera.agl_m / level_from_camera(camera)(2, 2) / lens.focal_px();
  const GroundImage source = averaged(frame, frame_observed, gsd_m / axis_gsd_m);
  require_short_sides(source.pixels.size());
  const cv::Point2d scale(source.pixels.cols / static_cast<double>(frame.cols),
                          source.pixels.rows / static_cast<double>(frame.rows));
  const GroundToFrame placed(camera, lens, box.tl(), gsd_m, max_range_m);
  GroundView view;
  view.image = {cv::Mat(size, frame.type()), cv::Mat(size, CV_8UC1), gsd_m};
  view.nadir_px = {-box.x / gsd_m, -box.y / gsd_m};
  view.nadir_sigma_m = nadir_sigma_m(camera);
  view.nadir_heading_sigma = nadir_heading_sigma(camera);
  for (int first = 0; first < size.height; first += kStripRows) {
    warp_rows(source, scale, placed, cv::Range(first, std::min(first + kStripRows, size.height)), view.image);
  }
  return view;
}

}  // namespace roadfix
