#include "cli/evaluation/panels.hpp"

#include <algorithm>
#include <iterator>
#include <opencv2/imgproc.hpp>

namespace roadfix::evaluation {
namespace {

constexpr int kTitlePx = 22;
constexpr int kGapPx = 6;

cv::Mat framed(const Panel& panel, int height_px) {
  const cv::Mat colour = coloured(panel.pixels);
  const double scale = static_cast<double>(height_px) / colour.rows;
  const cv::Size size(std::max(1, static_cast<int>(colour.cols * scale)), height_px);
  cv::Mat scaled;
  cv::resize(colour, scaled, size, 0, 0, scale < 1.0 ? cv::INTER_AREA : cv::INTER_NEAREST);
  cv::Mat result;
  cv::copyMakeBorder(scaled, result, kTitlePx, 0, 0, kGapPx, cv::BORDER_CONSTANT, cv::Scalar::all(255));
  cv::putText(result, panel.title, {2, kTitlePx - 7}, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar::all(0), 1,
              cv::LINE_AA);
  return result;
}

}  // namespace

cv::Mat coloured(const cv::Mat& pixels) {
  if (pixels.channels() == 3) return pixels;
  cv::Mat colour;
  cv::cvtColor(pixels, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

double strongest_of(const CellArray& cells) {
  constexpr double kShare = 0.98;
  constexpr double kFaintest = 0.25;
  std::vector<Cell> seen;
  std::ranges::copy_if(cells.cells(), std::back_inserter(seen), [](Cell c) { return is_observed(c) && c > 0; });
  if (seen.empty()) return 1.0;
  const auto at = seen.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(seen.size() - 1));
  std::ranges::nth_element(seen, at);
  return std::max(kFaintest, probability(*at));
}

cv::Mat side_by_side(const std::vector<Panel>& panels, int height_px) {
  std::vector<cv::Mat> columns;
  columns.reserve(panels.size());
  for (const Panel& panel : panels) columns.push_back(framed(panel, height_px));
  cv::Mat result;
  cv::hconcat(columns, result);
  return result;
}

}  // namespace roadfix::evaluation
