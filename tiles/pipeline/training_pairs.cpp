#include "tiles/pipeline/training_pairs.hpp"

#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "core/grid/cell.hpp"
#include "core/units/floor_div.hpp"

namespace roadfix {
namespace {

/// Of ground that was seen: what is darker counts as not seen where networks are trained.
constexpr std::uint8_t kDarkest = 4;

/// 255 where a cell is, by `is`.
cv::Mat marked(const CellArray& cells, bool (*is)(Cell)) {
  cv::Mat mask(cells.rows(), cells.cols(), CV_8UC1);
  for (int row = 0; row < cells.rows(); ++row) {
    auto* pixel = mask.ptr<std::uint8_t>(row);
    for (int col = 0; col < cells.cols(); ++col) pixel[col] = is(cells.at(col, row)) ? 255 : 0;
  }
  return mask;
}

double share_of(const cv::Mat& mask) { return cv::countNonZero(mask) / static_cast<double>(mask.total()); }

}  // namespace

double pair_gsd_m(double imagery_gsd_m) {
  constexpr double kNearly = 1.5;
  constexpr double kFinest = 0.5;
  constexpr double kCoarsest = 2.0;
  double gsd_m = kFinest;
  while (gsd_m < kCoarsest && kNearly * gsd_m < imagery_gsd_m) gsd_m *= 2.0;
  return gsd_m;
}

std::vector<GridGeometry> pair_squares(const Mosaic& imagery, const CellSource& roads, double gsd_m, int side_px) {
  std::vector<GridGeometry> squares;
  const GridBox box = intersection(imagery.extent(), roads.extent());
  if (box.empty()) return squares;
  const GridGeometry pixels = GridGeometry::covering(box, gsd_m);
  const auto first_of = [side_px](int pixel) { return floor_div(pixel, side_px) * side_px; };
  for (int row = first_of(pixels.origin.row); row < pixels.origin.row + pixels.rows; row += side_px) {
    for (int col = first_of(pixels.origin.col); col < pixels.origin.col + pixels.cols; col += side_px) {
      const GridGeometry square{gsd_m, {col, row}, side_px, side_px};
      if (imagery.touches(square.box()) && roads.touches(square.box())) squares.push_back(square);
    }
  }
  return squares;
}

TrainingPair training_pair(const Mosaic& imagery, const CellSource& roads, const GridGeometry& square) {
  const GroundImage ground = imagery.view(square.box(), square.cell_m);
  const CellArray cells = roads.read(square, 0);
  cv::Mat colours = ground.pixels;
  if (colours.channels() == 1) cv::cvtColor(ground.pixels, colours, cv::COLOR_GRAY2BGR);
  const cv::Mat seen = ground.observed & marked(cells, is_observed);
  TrainingPair pair;
  pair.picture = cv::Mat::zeros(colours.size(), CV_8UC3);
  cv::Mat(cv::max(colours, cv::Scalar::all(kDarkest))).copyTo(pair.picture, seen);
  pair.mask = marked(cells, is_road) & seen;
  pair.seen = share_of(seen);
  pair.road = share_of(pair.mask);
  return pair;
}

}  // namespace roadfix
