#include "tiles/imagery/warp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

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

/// Values times their weights, and these: of the type of the values, the largest one where all of a pixel is valid.
struct Weighted {
  cv::Mat values;
  cv::Mat weights;
};

/// Both averaged over reduction x reduction pixels.
void reduce(Weighted& pixels, int reduction) {
  pixels.values.setTo(cv::Scalar::all(0), pixels.weights == 0);
  if (reduction == 1) return;
  const cv::Size reduced((pixels.values.cols + reduction - 1) / reduction,
                         (pixels.values.rows + reduction - 1) / reduction);
  const int right = reduced.width * reduction - pixels.values.cols;
  const int bottom = reduced.height * reduction - pixels.values.rows;
  cv::Mat padded;
  for (cv::Mat* each : {&pixels.values, &pixels.weights}) {
    cv::copyMakeBorder(*each, padded, 0, bottom, 0, right, cv::BORDER_CONSTANT, cv::Scalar::all(0));
    cv::resize(padded, *each, reduced, 0, 0, cv::INTER_AREA);
  }
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

/// A part of the ground that takes about a megapixel of source.
struct Piece {
  cv::Rect pixels;
  cv::Point2d corner;  ///< the north-western one on the plane
};

/// Pixels of the source that become one, a power of two on a side.
int reduction_for(double gsd_m, double source_gsd_m) {
  return 1 << std::clamp(static_cast<int>(std::lround(std::log2(gsd_m / source_gsd_m))), 0, 10);
}

std::vector<Piece> pieces_of(const GridBox& box, cv::Size size, double gsd_m, int reduction) {
  const int side = std::max(1, kSourcePiecePx / reduction);
  std::vector<Piece> pieces;
  for (int row = 0; row < size.height; row += side) {
    for (int col = 0; col < size.width; col += side) {
      pieces.push_back({cv::Rect(col, row, side, side) & cv::Rect({0, 0}, size),
                        {box.min.east_m + col * gsd_m, box.max.north_m - row * gsd_m}});
    }
  }
  return pieces;
}

/// What `read` gives of windows of a raster of that size, on the pixels of the piece; nullopt where it knows nothing of
/// them.
template <typename Read>
std::optional<Weighted> warped(const Georeference& georeference, cv::Size raster, const Read& read, const Piece& piece,
                               double gsd_m, int reduction) {
  const PixelCoordinates coordinates(georeference, piece.corner, gsd_m, piece.pixels.size());
  const cv::Rect window = source_window(coordinates, raster, reduction);
  if (window.empty()) return std::nullopt;
  Weighted pixels = read(window);
  if (cv::countNonZero(pixels.weights) == 0) return std::nullopt;
  reduce(pixels, reduction);
  cv::Mat map(piece.pixels.size(), CV_32FC2);
  for (int row = 0; row < map.rows; ++row) {
    for (int col = 0; col < map.cols; ++col) {
      const cv::Point2d p = coordinates.at(col, row);
      const double x = (p.x - window.x) / reduction - 0.5;
      const double y = (p.y - window.y) / reduction - 0.5;
      constexpr double kFar = 1e6;  // also where the point has no place in the image: NaN fails the comparison
      const bool near = std::abs(x) < kFar && std::abs(y) < kFar;
      map.at<cv::Point2f>(row, col) =
          near ? cv::Point2f(static_cast<float>(x), static_cast<float>(y)) : cv::Point2f(-10.0F, -10.0F);
    }
  }
  Weighted result;
  cv::remap(pixels.values, result.values, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT,
            cv::Scalar::all(0));
  cv::remap(pixels.weights, result.weights, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT,
            cv::Scalar::all(0));
  return result;
}

}  // namespace

void warp_into(const PlacedRaster& raster, const GridBox& box, GroundImage& image) {
  const int reduction = reduction_for(image.gsd_m, raster.georeference.gsd_m());
  const auto read = [&](cv::Rect window) {
    RasterPixels pixels = raster.file.read(window, raster.range);
    if (raster.collar != nullptr) raster.collar->clear(window, pixels);
    return Weighted{pixels.values, pixels.valid};
  };
  for (const Piece& piece : pieces_of(box, image.pixels.size(), image.gsd_m, reduction)) {
    auto part = warped(raster.georeference, raster.file.size(), read, piece, image.gsd_m, reduction);
    if (!part) continue;
    cv::Mat target = image.pixels(piece.pixels);
    if (part->values.channels() == 3 && target.channels() == 1) {
      cv::cvtColor(part->values, part->values, cv::COLOR_BGR2GRAY);
    }
    fill(part->values, part->weights, target, image.observed(piece.pixels));
  }
}

void warp_into(const PlacedNumbers& raster, const GridBox& box, GroundNumbers& ground) {
  const int reduction = reduction_for(ground.gsd_m, raster.gsd_m);
  const auto read = [&](cv::Rect window) {
    Weighted pixels;
    const RasterPixels stored = raster.read(window);
    pixels.values = stored.values;
    stored.valid.convertTo(pixels.weights, CV_32F, 1.0 / 255.0);
    return pixels;
  };
  for (const Piece& piece : pieces_of(box, ground.sums.size(), ground.gsd_m, reduction)) {
    const auto part = warped(raster.georeference, raster.size, read, piece, ground.gsd_m, reduction);
    if (!part) continue;
    cv::Mat sums = ground.sums(piece.pixels);
    cv::Mat weights = ground.weights(piece.pixels);
    for (int row = 0; row < sums.rows; ++row) {
      for (int col = 0; col < sums.cols; ++col) {
        const float weight = part->weights.at<float>(row, col);
        if (weight <= 0.0F) continue;
        float& known = weights.at<float>(row, col);
        const float added = std::min(weight, 1.0F - known);
        sums.at<float>(row, col) += added * part->values.at<float>(row, col) / weight;
        known += added;
      }
    }
  }
}

}  // namespace roadfix
