#include "core/detect/lens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "core/units/angle.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

void require_coefficients(LensModel model, const std::vector<double>& distortion) {
  const std::size_t n = distortion.size();
  const bool fisheye = model == LensModel::kFisheye;
  if (n != 4 && (fisheye || (n != 0 && n != 5 && n != 8))) {
    throw InvalidInput(
        "frame-camera",
        fmt::format("frame: distortion must be {}, not {} numbers",
                    fisheye ? "k1, k2, k3, k4 of a fisheye" : "k1, k2, p1, p2 and then k3 and then k4, k5, k6", n));
  }
  if (!std::ranges::all_of(distortion, [](double k) { return std::isfinite(k); })) {
    throw InvalidInput("frame-camera", "frame: distortion must be finite numbers");
  }
}

}  // namespace

Lens::Lens(double focal_px, cv::Point2d principal, LensModel model, std::vector<double> distortion)
    : focal_px_(focal_px), principal_(principal), model_(model), distortion_(std::move(distortion)) {
  require_coefficients(model_, distortion_);
  if (!distortion_.empty()) widest_ = widest_ray();
}

/// The longest ray up to which pixels move outwards with their rays, in all directions; at most that of 85 degrees, as
/// no ground is seen at a flatter angle.
double Lens::widest_ray() const {
  constexpr int kDirections = 16;
  constexpr int kSteps = 340;
  const Angle step = Angle::degrees(0.25);
  std::vector<double> lengths;
  for (int i = 0; i <= kSteps; ++i) lengths.push_back(std::tan(i * step.radians()));
  std::size_t last = lengths.size() - 1;
  for (int d = 0; d < kDirections; ++d) {
    const Angle direction = Angle::degrees(360.0 * d / kDirections);
    std::vector<cv::Point2d> rays;
    for (const double length : lengths) rays.emplace_back(length * cos(direction), length * sin(direction));
    const std::vector<cv::Point2d> pixels = pixels_of(rays);
    for (std::size_t i = 1; i <= last; ++i) {
      if (!(cv::norm(pixels[i] - principal_) > cv::norm(pixels[i - 1] - principal_))) last = i - 1;
    }
  }
  return lengths[last];
}

cv::Matx33d Lens::intrinsics() const { return {focal_px_, 0, principal_.x, 0, focal_px_, principal_.y, 0, 0, 1}; }

std::vector<cv::Point2d> Lens::pixels_of(const std::vector<cv::Point2d>& rays) const {
  std::vector<cv::Point2d> pixels;
  pixels.reserve(rays.size());
  if (distortion_.empty()) {
    for (const cv::Point2d& ray : rays) pixels.push_back(ray * focal_px_ + principal_);
  } else if (model_ == LensModel::kFisheye) {
    cv::fisheye::distortPoints(rays, pixels, intrinsics(), distortion_);
  } else {
    std::vector<cv::Point3d> points;
    points.reserve(rays.size());
    for (const cv::Point2d& ray : rays) points.emplace_back(ray.x, ray.y, 1.0);
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), intrinsics(), distortion_, pixels);
  }
  return pixels;
}

std::optional<cv::Point2d> Lens::ray_of(cv::Point2d pixel) const {
  if (distortion_.empty()) return (pixel - principal_) / focal_px_;
  const cv::TermCriteria exact(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-10);
  std::vector<cv::Point2d> rays;
  if (model_ == LensModel::kFisheye) {
    cv::fisheye::undistortPoints(std::vector{pixel}, rays, intrinsics(), distortion_);
  } else {
    cv::undistortPoints(std::vector{pixel}, rays, intrinsics(), distortion_, cv::noArray(), cv::noArray(), exact);
  }
  constexpr double kSamePixel = 0.1;  // the iterations may converge to another ray
  if (!within(rays[0]) || !(cv::norm(pixels_of(rays)[0] - pixel) < kSamePixel)) return std::nullopt;
  return rays[0];
}

}  // namespace roadfix
