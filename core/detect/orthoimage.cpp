#include "core/detect/orthoimage.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roadfix {
namespace {

/// The part of the imagery that a cut can touch, empty if there is none: a whole city would take long to blur, and
/// OpenCV warps no picture with a side of 32,767 pixels or more.
Orthoimage around(const Orthoimage& imagery, const GridPoint& centre, const Footprint& footprint, double gsd_m) {
  const double blur_m = 4.0 * imagery.image.gsd_m + 2.0 * gsd_m;
  const double reach_m = std::hypot(footprint.width_m, footprint.height_m) / 2.0 + blur_m;
  return part_within(imagery, grown({centre, centre}, reach_m));
}

}  // namespace

GridBox Orthoimage::box() const {
  return {{north_west.east_m, north_west.north_m - image.pixels.rows * image.gsd_m},
          {north_west.east_m + image.pixels.cols * image.gsd_m, north_west.north_m}};
}

Orthoimage part_within(const Orthoimage& imagery, const GridBox& box) {
  const GroundImage& all = imagery.image;
  const auto pixel = [&](double metres, int count) {
    return static_cast<int>(std::clamp(std::floor(metres / all.gsd_m), 0.0, static_cast<double>(count)));
  };
  const auto at = [&](double east_m, double north_m) {
    return cv::Point(pixel(east_m - imagery.north_west.east_m, all.pixels.cols),
                     pixel(imagery.north_west.north_m - north_m, all.pixels.rows));
  };
  const cv::Rect part(at(box.min.east_m, box.max.north_m), at(box.max.east_m, box.min.north_m));
  return {{all.pixels(part), all.observed(part), all.gsd_m},
          {imagery.north_west.east_m + part.x * all.gsd_m, imagery.north_west.north_m - part.y * all.gsd_m}};
}

bool sees(const Orthoimage& imagery, GridPoint point) {
  const cv::Mat& observed = imagery.image.observed;
  const double col = std::floor((point.east_m - imagery.north_west.east_m) / imagery.image.gsd_m);
  const double row = std::floor((imagery.north_west.north_m - point.north_m) / imagery.image.gsd_m);
  return col >= 0 && row >= 0 && col < observed.cols && row < observed.rows &&
         observed.at<uchar>(static_cast<int>(row), static_cast<int>(col)) != 0;
}

std::array<GridPoint, 4> corners(const Footprint& footprint, const GridPose& pose) {
  const double w = footprint.width_m / 2.0;
  const double h = footprint.height_m / 2.0;
  const auto corner = [&](double forward, double right) { return moved(pose, {forward, right, {}}).position; };
  return {corner(h, -w), corner(h, w), corner(-h, w), corner(-h, -w)};
}

GroundImage cut_out(const Orthoimage& all, const GridPose& pose, const Footprint& footprint, double gsd_m) {
  const Orthoimage imagery = around(all, pose.position, footprint, gsd_m);
  const GroundImage& from = imagery.image;
  const auto pixels_of = [&](double metres) { return std::max(1, static_cast<int>(std::lround(metres / gsd_m))); };
  const cv::Size size(pixels_of(footprint.width_m), pixels_of(footprint.height_m));
  const double step = gsd_m / from.gsd_m;
  const double c = step * cos(pose.heading);
  const double s = step * sin(pose.heading);
  if (from.pixels.empty()) return {cv::Mat::zeros(size, from.pixels.type()), cv::Mat::zeros(size, CV_8UC1), gsd_m};
  // Pixel centres: source = at + R (target - centre), with OpenCV's integer coordinates at pixel centres.
  const double at_x = (pose.position.east_m - imagery.north_west.east_m) / from.gsd_m - 0.5;
  const double at_y = (imagery.north_west.north_m - pose.position.north_m) / from.gsd_m - 0.5;
  const double centre_x = size.width / 2.0 - 0.5;
  const double centre_y = size.height / 2.0 - 0.5;
  const cv::Matx23d source_from_target(c, -s, at_x - c * centre_x + s * centre_y,  //
                                       s, c, at_y - s * centre_x - c * centre_y);
  // A coarser picture must average, not skip, the pixels below it.
  cv::Mat pixels = from.pixels;
  if (step > 1.0) cv::GaussianBlur(from.pixels, pixels, {}, 0.5 * std::sqrt(step * step - 1.0));
  GroundImage cut;
  cut.gsd_m = gsd_m;
  cv::warpAffine(pixels, cut.pixels, source_from_target, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  cv::warpAffine(from.observed, cut.observed, source_from_target, size, cv::INTER_NEAREST | cv::WARP_INVERSE_MAP,
                 cv::BORDER_CONSTANT, cv::Scalar(0));
  return cut;
}

}  // namespace roadfix
