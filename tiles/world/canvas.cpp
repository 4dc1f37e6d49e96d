#include "tiles/world/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/fixed_point.hpp"
#include "tiles/world/polygon.hpp"

namespace roadfix::world {
namespace {

cv::Scalar scalar(const Colour& c) {
  return {std::clamp(c[0], 0.0, 255.0), std::clamp(c[1], 0.0, 255.0), std::clamp(c[2], 0.0, 255.0)};
}

}  // namespace

Canvas::Canvas(cv::Rect pixels, double gsd_m)
    : pixels_(pixels),
      gsd_m_(gsd_m),
      ground_(pixels.x * gsd_m, pixels.y * gsd_m, pixels.width * gsd_m, pixels.height * gsd_m),
      colour_(pixels.size(), cv::Vec3b(0, 0, 0)),
      material_(pixels.size(), static_cast<std::uint8_t>(Material::kBare)),
      height_(pixels.size(), 0.0F) {}

bool Canvas::sees(PlanPoint centre, double radius_m) const {
  return centre.x + radius_m >= ground_.x && centre.x - radius_m <= ground_.x + ground_.width &&
         centre.y + radius_m >= ground_.y && centre.y - radius_m <= ground_.y + ground_.height;
}

bool Canvas::sees(const Polyline& outline) const {
  const cv::Rect2d box = box_of(outline);
  return sees({box.x + box.width / 2.0, box.y + box.height / 2.0}, std::hypot(box.width, box.height) / 2.0);
}

/// OpenCV's sub-pixel coordinates: a pixel's centre is at whole numbers.
cv::Point Canvas::on_tile(PlanPoint p) const {
  return fixed_point({p.x / gsd_m_ - pixels_.x - 0.5, p.y / gsd_m_ - pixels_.y - 0.5});
}

void Canvas::fill_shape(const Polyline& polygon, const Colour& colour, Material material, const double* height_m) {
  std::vector<std::vector<cv::Point>> shape(1);
  for (const PlanPoint& p : polygon) shape[0].push_back(on_tile(p));
  cv::fillPoly(colour_, shape, scalar(colour), cv::LINE_AA, kFraction);
  cv::fillPoly(material_, shape, static_cast<double>(material), cv::LINE_8, kFraction);
  if (height_m != nullptr) cv::fillPoly(height_, shape, *height_m, cv::LINE_8, kFraction);
}

void Canvas::fill(const Polyline& polygon, const Colour& colour, Material material) {
  fill_shape(polygon, colour, material, nullptr);
}

void Canvas::fill(const Polyline& polygon, const Colour& colour, Material material, double height_m) {
  fill_shape(polygon, colour, material, &height_m);
}

void Canvas::disc(PlanPoint centre, double radius_m, const Colour& colour, Material material, double height_m) {
  const cv::Point at = on_tile(centre);
  const int radius = std::max(1, static_cast<int>(std::lround(radius_m / gsd_m_ * (1 << kFraction))));
  cv::circle(colour_, at, radius, scalar(colour), cv::FILLED, cv::LINE_AA, kFraction);
  cv::circle(material_, at, radius, static_cast<double>(material), cv::FILLED, cv::LINE_8, kFraction);
  if (height_m > 0.0) cv::circle(height_, at, radius, height_m, cv::FILLED, cv::LINE_8, kFraction);
}

void Canvas::stroke(const Polyline& line, double width_m, const Colour& colour, Material material) {
  const double half = width_m / 2.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const PlanPoint a = line[i];
    const PlanPoint b = line[i + 1];
    if (!sees((a + b) / 2.0, cv::norm(b - a) / 2.0 + width_m)) continue;
    const PlanPoint along = direction(line, i);
    const PlanPoint side = perpendicular(along) * half;
    fill({a + side, b + side, b - side, a - side}, colour, material);
    if (width_m > 2.0 * gsd_m_) {
      disc(a, half, colour, material, 0.0);
      disc(b, half, colour, material, 0.0);
    }
  }
}

}  // namespace roadfix::world
