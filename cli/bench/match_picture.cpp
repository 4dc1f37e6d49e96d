#include "cli/bench/match_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cli/evaluation/panels.hpp"

namespace roadfix::bench {
namespace {

constexpr int kHeightPx = 700;
const cv::Scalar kRight(60, 200, 60);
const cv::Scalar kWrong(60, 60, 230);

GridBox common_box(std::span<const Orthoimage> imagery) {
  GridBox box = imagery.front().box();
  for (const Orthoimage& ortho : imagery) box = united(box, ortho.box());
  return box;
}

/// All imagery in one picture, north up; where some overlap the first one shows.
cv::Mat mosaic(std::span<const Orthoimage> imagery, const GridBox& box, double gsd_m) {
  const auto px = [&](double metres) { return static_cast<int>(std::lround(metres / gsd_m)); };
  cv::Mat canvas(std::max(1, px(box.height_m())), std::max(1, px(box.width_m())), CV_8UC3, cv::Scalar::all(90));
  const cv::Rect all({}, canvas.size());
  for (std::size_t i = imagery.size(); i-- > 0;) {
    const Orthoimage& ortho = imagery[i];
    const GridBox own = ortho.box();
    const cv::Rect place = cv::Rect(px(own.min.east_m - box.min.east_m), px(box.max.north_m - own.max.north_m),
                                    px(own.width_m()), px(own.height_m())) &
                           all;
    if (place.empty()) continue;
    cv::Mat shown;
    cv::resize(evaluation::coloured(ortho.image.pixels), shown, place.size(), 0, 0, cv::INTER_AREA);
    shown.copyTo(canvas(place));
  }
  return canvas;
}

}  // namespace

std::vector<bool> right_matches(const PointMatches& matches, GridPoint origin, const GroundView& view,
                                const GridPose& truth, double tolerance_m) {
  std::vector<bool> right;
  for (std::size_t i = 0; i < matches.frame_px.size(); ++i) {
    const cv::Point2d seen = matches.frame_px[i];
    const cv::Point2d known = matches.map_m[i];
    const double across = (seen.x + 0.5 - view.nadir_px.x) * view.image.gsd_m;
    const double ahead = (view.nadir_px.y - 0.5 - seen.y) * view.image.gsd_m;
    const GridPoint found{origin.east_m + known.x, origin.north_m - known.y};
    right.push_back(distance_m(found, moved(truth, {ahead, across, {}}).position) <= tolerance_m);
  }
  return right;
}

cv::Mat match_picture(std::span<const Orthoimage> imagery, const GroundView& view, const PointMatches& matches,
                      const std::optional<GridPose>& truth) {
  const GridBox box = common_box(imagery);
  const GridPoint origin = imagery.front().north_west;
  const double gsd_m = box.height_m() / kHeightPx;
  const double frame_scale = static_cast<double>(kHeightPx) / view.image.pixels.rows;
  cv::Mat before = mosaic(imagery, box, gsd_m);
  cv::Mat after;
  cv::resize(evaluation::coloured(view.image.pixels), after, {}, frame_scale, frame_scale, cv::INTER_AREA);
  cv::resize(before, before, {before.cols, after.rows});
  std::vector<bool> right(matches.map_m.size(), false);
  if (truth) right = right_matches(matches, origin, view, *truth, kRightMatchM);

  cv::Mat both;
  cv::hconcat(before, after, both);
  for (std::size_t i = 0; i < right.size(); ++i) {
    const cv::Point2d seen = matches.frame_px[i];
    const cv::Point2d known = matches.map_m[i];
    const cv::Point2d from((origin.east_m + known.x - box.min.east_m) / gsd_m,
                           (box.max.north_m - origin.north_m + known.y) / gsd_m);
    const cv::Point2d to(before.cols + seen.x * frame_scale, seen.y * frame_scale);
    cv::line(both, from, to, right[i] ? kRight : kWrong, 1, cv::LINE_AA);
  }
  return evaluation::side_by_side({{fmt::format("{} matches, {} of them right within {} m", right.size(),
                                                std::ranges::count(right, true), kRightMatchM),
                                    both}},
                                  both.rows);
}

}  // namespace roadfix::bench
