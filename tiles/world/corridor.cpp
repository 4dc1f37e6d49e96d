#include "tiles/world/corridor.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/fixed_point.hpp"

namespace roadfix::world {
namespace {

std::vector<cv::Point> cells_of(const Polyline& line) {
  std::vector<cv::Point> result;
  for (const PlanPoint& p : line) {
    // OpenCV's whole numbers are at the centres of cells.
    result.push_back(fixed_point({p.x + Corridor::kMarginM - 0.5, p.y + Corridor::kMarginM - 0.5}));
  }
  return result;
}

cv::Point cell_of(PlanPoint p) {
  return {static_cast<int>(std::floor(p.x)) + Corridor::kMarginM,
          static_cast<int>(std::floor(p.y)) + Corridor::kMarginM};
}

}  // namespace

Corridor::Corridor(const Plan& plan)
    : cells_(static_cast<int>(std::ceil(plan.height_m)) + 2 * kMarginM,
             static_cast<int>(std::ceil(plan.width_m)) + 2 * kMarginM, std::uint8_t{0}) {}

void Corridor::add(const Polyline& line, double width_m) {
  const int width = std::max(1, static_cast<int>(std::lround(width_m)));
  cv::polylines(cells_, std::vector{cells_of(line)}, false, 255, width, cv::LINE_8, kFraction);
}

void Corridor::add(const std::vector<Street>& streets, double wider_m) {
  for (const Street& street : streets) add(street.line, street.width_m + wider_m);
}

void Corridor::add_area(const Polyline& outline) {
  cv::fillPoly(cells_, std::vector{cells_of(outline)}, 255, cv::LINE_8, kFraction);
}

bool Corridor::contains(PlanPoint p) const {
  const cv::Point cell = cell_of(p);
  return cv::Rect({}, cells_.size()).contains(cell) && cells_(cell) != 0;
}

double Corridor::share_of(const Polyline& line) const {
  int inside = 0;
  int all = 0;
  walk(line, 0.0, 2.0, [&](PlanPoint p, PlanPoint) {
    ++all;
    if (contains(p)) ++inside;
  });
  return all > 0 ? static_cast<double>(inside) / all : 0.0;
}

cv::Mat1f Corridor::distances() const {
  cv::Mat1f result;
  cv::distanceTransform(cells_ == 0, result, cv::DIST_L2, cv::DIST_MASK_5);
  return result;
}

double Corridor::at(const cv::Mat1f& raster, PlanPoint p) {
  const cv::Point cell = cell_of(p);
  return static_cast<double>(raster(std::clamp(cell.y, 0, raster.rows - 1), std::clamp(cell.x, 0, raster.cols - 1)));
}

std::vector<Polyline> outside_of(const Corridor& corridor, const Polyline& line) {
  std::vector<Polyline> parts(1);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool through = i > 0 && corridor.share_of({line[i - 1], line[i]}) > 0.0;
    if (corridor.contains(line[i]) || through) {
      if (!parts.back().empty()) parts.emplace_back();
      if (corridor.contains(line[i])) continue;
    }
    parts.back().push_back(line[i]);
  }
  std::erase_if(parts, [](const Polyline& part) { return part.size() < 2; });
  return parts;
}

}  // namespace roadfix::world
