#include "tiles/sources/warp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace roadfix {
namespace {

constexpr int kSourcePiecePx = 1024;
constexpr int kNodeStepPx = 16;
constexpr int kHalfWeight = 128;

/// Source pixel coordinates of the centres of all pixels of a piece: exact at every 16th, bilinear in between.
class PixelCoordinates {
 public:
  PixelCoordinates(const Georeference& georeference, cv::Point2d corner, double gsd_m, cv::Size size)
      : step_(std::clamp(std::max(size.width, size.height), 1, kNodeStepPx)),
        cols_((size.width - 1) / step_ + 2),
        nodes_(nodes(corner, gsd_m, size)) {
    georeference.to_pixels(nodes_);
  }

  cv::Point2d at(int col, int row) const {
    const int i = col / step_;
    const int j = row / step_;
    const double u = static_cast<double>(col % step_) / step_;
    const double v = static_cast<double>(row % step_) / step_;
    const cv::Point2d north = node(i, j) * (1.0 - u) + node(i + 1, j) * u;
    const cv::Point2d south = node(i, j + 1) * (1.0 - u) + node(i + 1, j + 1) * u;
    return north * (1.0 - v) + south * v;
  }
  const std::vector<cv::Point2d>& all_nodes() const { return nodes_; }

 private:
  std::vector<cv::Point2d> nodes(cv::Point2d corner, double gsd_m, cv::Size size) const {
    const int rows = (size.height - 1) / step_ + 2;
    std::vector<cv::Point2d> result;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < cols_; ++i) {
        result.emplace_back(corner.x + (i * step_ + 0.5) * gsd_m, corner.y - (j * step_ + 0.5) * gsd_m);
      }
    }
    return result;
  }
  cv::Point2d node(int i, int j) const {
    return nodes_[static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(i)];
  }

  int step_;
  int cols_;
  std::vector<cv::Point2d> nodes_;
};

/// The part of the raster that the piece needs, its corner on multiples of `reduction`; empty when it needs none.
cv::Rect source_window(const PixelCoordinates& coordinates, cv::Size image, int reduction) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  cv::Point2d low(kInfinity, kInfinity);
  cv::Point2d high(-kInfinity, -kInfinity);
  for (const cv::Point2d& p : coordinates.all_nodes()) {
    if (std::isnan(p.x)) continue;
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const int margin = 2 * reduction;
  if (!(high.x > -margin && high.y > -margin && low.x < image.width + margin && low.y < image.height + margin))
    return {};
  const auto first = [&](double x) {
    return std::max(0, static_cast<int>(std::floor(x)) - margin) / reduction * reduction;
  };
  const auto last = [&](double x, int limit) {
    return std::min(limit, static_cast<int>(std::min(std::ceil(x) + margin, static_cast<double>(limit))));
  };
  const cv::Point from(first(std::clamp(low.x, 0.0, 1e9)), first(std::clamp(low.y, 0.0, 1e9)));
  const cv::Point to(last(high.x, image.width), last(high.y, image.height));
  if (to.x <= from.x || to.y <= from.y) return {};
  return {from, to};
}

/// Values weighted by validity, and the weight, both averaged over reduction x reduction pixels.
void reduce(RasterPixels& pixels, int reduction) {
  pixels.values.setTo(cv::Scalar::all(0), pixels.valid == 0);
  if (reduction == 1) return;
  const cv::Size reduced((pixels.values.cols + reduction - 1) / reduction,
                         (pixels.values.rows + reduction - 1) / reduction);
  const int right = reduced.width * reduction - pixels.values.cols;
  const int bottom = reduced.height * reduction - pixels.values.rows;
  cv::Mat padded;
  cv::copyMakeBorder(pixels.values, padded, 0, bottom, 0, right, cv::BORDER_CONSTANT, cv::Scalar::all(0));
  cv::resize(padded, pixels.values, reduced, 0, 0, cv::INTER_AREA);
  cv::copyMakeBorder(pixels.valid, padded, 0, bottom, 0, right, cv::BORDER_CONSTANT, cv::Scalar::all(0));
  cv::resize(padded, pixels.valid, reduced, 0, 0, cv::INTER_AREA);
}

void fill(const cv::Mat& values, const cv::Mat& weights, cv::Mat target, cv::Mat observed) {
  const int channels = values.channels();
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const int weight = weights.at<std::uint8_t>(row, col);
      std::uint8_t& seen = observed.at<std::uint8_t>(row, col);
      if (seen != 0 || weight < kHalfWeight) continue;
      const std::uint8_t* from = values.ptr<std::uint8_t>(row, col);
      std::uint8_t* to = target.ptr<std::uint8_t>(row, col);
      for (int c = 0; c < target.channels(); ++c) {
        const int value = from[channels == 1 ? 0 : c];
        to[c] = static_cast<std::uint8_t>(std::min(255, (value * 255 + weight / 2) / weight));
      }
      seen = 255;
    }
  }
}

void warp_piece(const PlacedRaster& raster, cv::Point2d corner, int reduction, double gsd_m, cv::Mat target,
                cv::Mat observed) {
  const PixelCoordinates coordinates(raster.georeference, corner, gsd_m, target.size());
  const cv::Rect window = source_window(coordinates, raster.file.size(), reduction);
  if (window.empty()) return;
  RasterPixels pixels = raster.file.read(window, raster.range);
  if (raster.collar != nullptr) raster.collar->clear(window, pixels);
  if (cv::countNonZero(pixels.valid) == 0) return;
  reduce(pixels, reduction);
  cv::Mat map(target.size(), CV_32FC2);
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const cv::Point2d p = coordinates.at(col, row);
      const double x = (p.x - window.x) / reduction - 0.5;
      const double y = (p.y - window.y) / reduction - 0.5;
      constexpr double kFar = 1e6;  // also where the point has no place in the image: NaN fails the comparison
      const bool near = std::abs(x) < kFar && std::abs(y) < kFar;
      map.at<cv::Point2f>(row, col) =
          near ? cv::Point2f(static_cast<float>(x), static_cast<float>(y)) : cv::Point2f(-10.0F, -10.0F);
    }
  }
  cv::Mat values;
  cv::Mat weights;
  cv::remap(pixels.values, values, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(0));
  cv::remap(pixels.valid, weights, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(0));
  if (values.channels() == 3 && target.channels() == 1) cv::cvtColor(values, values, cv::COLOR_BGR2GRAY);
  fill(values, weights, target, observed);
}

}  // namespace

void warp_into(const PlacedRaster& raster, const GridBox& box, GroundImage& image) {
  const double ratio = image.gsd_m / raster.georeference.gsd_m();
  const int reduction = 1 << std::clamp(static_cast<int>(std::lround(std::log2(ratio))), 0, 10);
  const int piece = std::max(1, kSourcePiecePx / reduction);
  const cv::Rect whole({0, 0}, image.pixels.size());
  for (int row = 0; row < whole.height; row += piece) {
    for (int col = 0; col < whole.width; col += piece) {
      const cv::Rect part = cv::Rect(col, row, piece, piece) & whole;
      const cv::Point2d corner(box.min.east_m + col * image.gsd_m, box.max.north_m - row * image.gsd_m);
      warp_piece(raster, corner, reduction, image.gsd_m, image.pixels(part), image.observed(part));
    }
  }
}

}  // namespace roadfix
