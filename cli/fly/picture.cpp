#include "cli/fly/picture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cli/evaluation/panels.hpp"
#include "core/locate/ellipse.hpp"

namespace roadfix::fly {
namespace {

const cv::Scalar kOrange(0, 140, 255);
const cv::Scalar kGreen(60, 220, 60);
const cv::Scalar kRed(40, 40, 255);
const cv::Scalar kBlue(255, 160, 60);
const cv::Scalar kBlack(0, 0, 0);
const cv::Scalar kWhite(255, 255, 255);
constexpr int kShift = 4;  // fractional bits of OpenCV's drawing coordinates

cv::Point fine(cv::Point2d p) {
  const double scale = 1 << kShift;
  return {static_cast<int>(std::lround(p.x * scale)), static_cast<int>(std::lround(p.y * scale))};
}

/// Dark outlines keep colours visible on any ground.
template <typename Draw>
void outlined(const cv::Scalar& colour, int thickness, Draw draw) {
  draw(kBlack, thickness + 2);
  draw(colour, thickness);
}

void draw_path(cv::Mat& picture, const std::vector<cv::Point2d>& points, bool closed, const cv::Scalar& colour,
               int thickness) {
  std::vector<cv::Point> line;
  line.reserve(points.size());
  for (const cv::Point2d& p : points) line.push_back(fine(p));
  outlined(colour, thickness,
           [&](const cv::Scalar& c, int t) { cv::polylines(picture, line, closed, c, t, cv::LINE_AA, kShift); });
}

void draw_pose(cv::Mat& picture, const Backdrop& backdrop, const GridPose& pose, const cv::Scalar& colour,
               double length_px) {
  const cv::Point2d from = backdrop.at(pose.position);
  const cv::Point2d to = from + length_px * cv::Point2d(sin(pose.heading), -cos(pose.heading));
  outlined(colour, 2, [&](const cv::Scalar& c, int t) {
    cv::arrowedLine(picture, from, to, c, t, cv::LINE_AA, 0, 0.35);
    cv::circle(picture, from, 3 + (t > 2 ? 1 : 0), c, cv::FILLED, cv::LINE_AA);
  });
}

void draw_estimate(cv::Mat& picture, const Backdrop& backdrop, const UtmZone& zone, const Record& record) {
  const TrackCluster& best = record.estimate.clusters.front();
  const cv::Point2d at = backdrop.at(record.best.position);
  const double radius = std::max(best.radius95_m / backdrop.gsd_m, 3.0);
  outlined(kBlue, 1, [&](const cv::Scalar& c, int t) {
    cv::circle(picture, fine(at), fine({radius, 0}).x, c, t, cv::LINE_AA, kShift);
  });
  const Ellipse ellipse = on_grid(best.ellipse, zone, record.best.position);
  const cv::Size2d half(std::max(kSigmasOf95 * ellipse.sigma_m[0] / backdrop.gsd_m, 2.0),
                        std::max(kSigmasOf95 * ellipse.sigma_m[1] / backdrop.gsd_m, 2.0));
  outlined(kRed, 1, [&](const cv::Scalar& c, int t) {
    // OpenCV turns clockwise from the x axis, headings count from north.
    cv::ellipse(picture, fine(at), cv::Size(fine({half.width, half.height})), ellipse.heading.degrees() - 90.0, 0.0,
                360.0, c, t, cv::LINE_AA, kShift);
  });
  draw_pose(picture, backdrop, record.best, kRed, 18.0);
}

void draw_caption(cv::Mat& picture, const std::string& caption) {
  constexpr int kHeight = 22;
  cv::rectangle(picture, {0, 0, picture.cols, kHeight}, kBlack, cv::FILLED);
  cv::putText(picture, caption, {6, kHeight - 7}, cv::FONT_HERSHEY_SIMPLEX, 0.42, kWhite, 1, cv::LINE_AA);
}

/// Cells of the map, coarse enough for the picture.
RoadGrid overview(const MapView& map, double gsd_m) {
  double cell_m = map.cell_m;
  while (2.0 * cell_m <= gsd_m) cell_m *= 2.0;
  return map.read(GridGeometry::covering(map.extent, cell_m));
}

cv::Mat shades(const RoadGrid& grid) {
  constexpr double kGround = 235.0;
  const double darkest = evaluation::strongest_of(grid.cells);
  cv::Mat grey(grid.cells.rows(), grid.cells.cols(), CV_8UC1);
  for (int row = 0; row < grey.rows; ++row) {
    for (int col = 0; col < grey.cols; ++col) {
      const Cell cell = grid.cells.at(col, row);
      grey.at<uchar>(row, col) =
          is_observed(cell)
              ? cv::saturate_cast<uchar>(kGround * (1.0 - 0.8 * std::min(1.0, probability(cell) / darkest)))
              : uchar{160};
    }
  }
  return grey;
}

void lay_imagery(Backdrop& backdrop, const Orthoimage& all) {
  const Orthoimage imagery = part_within(all, backdrop.box);
  const GridBox box = imagery.box();
  const auto pixel = [&](GridPoint point) { return cv::Point(backdrop.at(point)); };  // the nearest corner of pixels
  const cv::Rect place = cv::Rect(pixel({box.min.east_m, box.max.north_m}), pixel({box.max.east_m, box.min.north_m})) &
                         cv::Rect({}, backdrop.pixels.size());
  if (place.empty()) return;
  cv::Mat shown;
  cv::Mat observed;
  cv::resize(evaluation::coloured(imagery.image.pixels), shown, place.size(), 0, 0, cv::INTER_AREA);
  cv::resize(imagery.image.observed, observed, place.size(), 0, 0, cv::INTER_NEAREST);
  shown.copyTo(backdrop.pixels(place), observed);
}

}  // namespace

Backdrop backdrop_of(const MapView& map, const Orthoimage* imagery, int longest_px) {
  Backdrop backdrop;
  backdrop.gsd_m = std::max(map.extent.width_m(), map.extent.height_m()) / longest_px;
  const RoadGrid grid = overview(map, backdrop.gsd_m);
  backdrop.box = grid.geometry.box();
  const cv::Size size(std::max(1, static_cast<int>(backdrop.box.width_m() / backdrop.gsd_m)),
                      std::max(1, static_cast<int>(backdrop.box.height_m() / backdrop.gsd_m)));
  cv::Mat grey;
  cv::resize(shades(grid), grey, size, 0, 0, cv::INTER_AREA);
  cv::cvtColor(grey, backdrop.pixels, cv::COLOR_GRAY2BGR);
  if (imagery != nullptr) lay_imagery(backdrop, *imagery);
  return backdrop;
}

cv::Mat drawn(const Backdrop& backdrop, const UtmZone& zone, const Scene& scene) {
  cv::Mat picture = backdrop.pixels.clone();
  const auto pixels = [&](const auto& points) {
    std::vector<cv::Point2d> result;
    for (const GridPoint& point : points) result.push_back(backdrop.at(point));
    return result;
  };
  for (const GridPose& particle : scene.particles) {
    const cv::Point2d at = backdrop.at(particle.position);
    cv::circle(picture, fine(at), 24, kOrange, cv::FILLED, cv::LINE_AA, kShift);
  }
  draw_path(picture, pixels(scene.path), false, kGreen, 1);
  draw_path(picture, pixels(corners(scene.footprint, scene.record->truth)), true, kGreen, 1);
  draw_pose(picture, backdrop, scene.record->truth, kGreen, 30.0);
  draw_estimate(picture, backdrop, zone, *scene.record);
  draw_caption(picture, scene.caption);
  return picture;
}

}  // namespace roadfix::fly
