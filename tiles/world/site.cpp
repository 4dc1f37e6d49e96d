#include "tiles/world/site.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tiles/world/fixed_point.hpp"

namespace roadfix::world {
namespace {

std::vector<cv::Point> fixed_points(const Polyline& line, PlanPoint origin = {}) {
  std::vector<cv::Point> result;
  for (const PlanPoint& p : line) result.push_back(fixed_point(p - origin));
  return result;
}

void draw(cv::Mat1b& mask, const Polyline& line, double width_m) {
  cv::polylines(mask, std::vector{fixed_points(line)}, false, 255, std::max(1, static_cast<int>(std::lround(width_m))),
                cv::LINE_8, kFraction);
}

}  // namespace

double sidewalk_m(const Street& street) {
  if (street.width_m >= 10.0) return 3.0;
  return street.width_m >= 6.0 ? 1.8 : 0.8;
}

Site::Site(const Plan& plan) {
  const cv::Size size(static_cast<int>(std::ceil(plan.width_m)), static_cast<int>(std::ceil(plan.height_m)));
  taken_ = cv::Mat1b(size, std::uint8_t{0});
  for (const Street& street : plan.streets) draw(taken_, street.line, street.width_m + 2.0 * sidewalk_m(street));
  if (!plan.river.empty()) draw(taken_, plan.river, plan.river_width_m * 1.5);
  cv::Mat centroids;
  cv::connectedComponentsWithStats(taken_ == 0, block_, stats_, centroids, 4, CV_32S);
}

int Site::block_at(PlanPoint p) const {
  const cv::Point cell(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)));
  return cv::Rect({}, block_.size()).contains(cell) ? block_(cell) : 0;
}

bool Site::is_free(PlanPoint p) const {
  const cv::Point cell(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)));
  return cv::Rect({}, taken_.size()).contains(cell) && taken_(cell) == 0;
}

cv::Rect Site::cells_of(const Footprint& footprint) const {
  const double reach = footprint.radius_m() + 2.0;
  const cv::Point corner(static_cast<int>(std::floor(footprint.centre.x - reach)),
                         static_cast<int>(std::floor(footprint.centre.y - reach)));
  const int side = static_cast<int>(std::ceil(2.0 * reach)) + 1;
  return {corner, cv::Size(side, side)};
}

bool Site::has_room(const Footprint& footprint, int block) const {
  const cv::Rect cells = cells_of(footprint);
  if ((cells & cv::Rect({}, taken_.size())) != cells) return false;
  cv::Mat1b shape(cells.size(), std::uint8_t{0});
  cv::fillConvexPoly(shape, fixed_points(footprint.corners(), PlanPoint(cells.tl())), 255, cv::LINE_8, kFraction);
  for (int y = 0; y < cells.height; ++y) {
    for (int x = 0; x < cells.width; ++x) {
      if (shape(y, x) == 0) continue;
      if (taken_(cells.y + y, cells.x + x) != 0 || block_(cells.y + y, cells.x + x) != block) return false;
    }
  }
  return true;
}

void Site::occupy(const Footprint& footprint) {
  cv::fillConvexPoly(taken_, fixed_points(footprint.corners()), 255, cv::LINE_8, kFraction);
}

std::vector<Block> Site::blocks() const {
  std::vector<Block> blocks(static_cast<std::size_t>(stats_.rows - 1));
  for (int i = 1; i < stats_.rows; ++i) {
    const cv::Rect box(stats_(i, cv::CC_STAT_LEFT), stats_(i, cv::CC_STAT_TOP), stats_(i, cv::CC_STAT_WIDTH),
                       stats_(i, cv::CC_STAT_HEIGHT));
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(block_(box) == i, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE, box.tl());
    if (contours.empty()) continue;
    std::vector<cv::Point> outline;
    cv::approxPolyDP(contours.front(), outline, 1.5, true);
    Block& block = blocks[static_cast<std::size_t>(i - 1)];
    block.area_m2 = stats_(i, cv::CC_STAT_AREA);
    for (const cv::Point& p : outline) block.outline.emplace_back(p.x + 0.5, p.y + 0.5);
  }
  return blocks;
}

}  // namespace roadfix::world
