#include "core/detect/network_picture.hpp"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

int whole(double length) { return static_cast<int>(std::ceil(length - 1e-9)); }

cv::Size scaled(cv::Size size, double factor) { return {whole(size.width * factor), whole(size.height * factor)}; }

/// The image itself where it is that large.
cv::Mat padded(const cv::Mat& image, cv::Size size, const cv::Scalar& value) {
  if (image.rows >= size.height && image.cols >= size.width) return image;
  cv::Mat result;
  cv::copyMakeBorder(image, result, 0, std::max(0, size.height - image.rows), 0, std::max(0, size.width - image.cols),
                     cv::BORDER_CONSTANT, value);
  return result;
}

/// Resized by exactly `factor` (cv::resize with a size would stretch to whole pixels), with `value` beyond the border.
cv::Mat resized(const cv::Mat& image, double factor, const cv::Scalar& value) {
  if (std::abs(factor - 1.0) < 1e-9) return image;
  const cv::Size target = scaled(image.size(), factor);
  const cv::Size source = scaled(target, 1.0 / factor);
  cv::Mat result;
  cv::resize(padded(image, source, value), result, {}, factor, factor,
             factor < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
  return padded(result, target, value)(cv::Rect({}, target));
}

/// Sum over the square window around each pixel; nothing lies beyond the border.
cv::Mat window_sum(const cv::Mat& values, int window_px) {
  cv::Mat sum;
  cv::boxFilter(values, sum, CV_32F, {window_px, window_px}, {-1, -1}, false, cv::BORDER_CONSTANT);
  return sum;
}

void to_local_contrast(cv::Mat& bgr, const cv::Mat& observed, const LocalContrast& local) {
  constexpr double kOffset = 118.0;  // keeps the sums of squares small
  bgr -= cv::Scalar::all(kOffset);
  cv::Mat grey;
  cv::transform(bgr, grey, cv::Matx13f(1.0F / 3, 1.0F / 3, 1.0F / 3));
  grey.setTo(0, observed == 0);
  cv::Mat seen;
  observed.convertTo(seen, CV_32F);
  cv::threshold(seen, seen, 0.5, 1.0, cv::THRESH_BINARY);
  // In place, and released as soon as possible: for large pictures these take more memory than anything else.
  cv::Mat count = window_sum(seen, local.window_px);
  seen.release();
  cv::max(count, 1.0, count);
  cv::Mat mean = window_sum(grey, local.window_px);
  cv::divide(mean, count, mean);
  cv::multiply(grey, grey, grey);
  cv::Mat spread = window_sum(grey, local.window_px);
  cv::divide(spread, count, spread);
  cv::multiply(mean, mean, grey);
  cv::subtract(spread, grey, spread);
  cv::max(spread, 0.0, spread);
  cv::sqrt(spread, spread);
  spread += local.floor;
  for (int row = 0; row < bgr.rows; ++row) {
    for (int col = 0; col < bgr.cols; ++col) {
      bgr.at<cv::Vec3f>(row, col) -= cv::Vec3f::all(mean.at<float>(row, col));
      bgr.at<cv::Vec3f>(row, col) /= spread.at<float>(row, col);
    }
  }
}

void check(const GroundImage& image) {
  const int type = image.pixels.type();
  if (image.pixels.empty() || (type != CV_8UC3 && type != CV_8UC1) || image.observed.type() != CV_8UC1 ||
      image.observed.size() != image.pixels.size() || !(image.gsd_m > 0.0)) {
    throw InvalidInput(
        "image-shape",
        fmt::format("A picture of {} x {} pixels with {} m per pixel and a mask of {} x {}: "
                    "give 8-bit grey or BGR pixels and a mask of the same size.",
                    image.pixels.cols, image.pixels.rows, image.gsd_m, image.observed.cols, image.observed.rows));
  }
}

/// BGR, with `value` where nothing was seen.
cv::Mat without_unseen(const GroundImage& image, const cv::Scalar& value) {
  cv::Mat bgr = image.pixels;
  if (image.pixels.channels() == 1) cv::cvtColor(image.pixels, bgr, cv::COLOR_GRAY2BGR);
  const cv::Mat unseen = image.observed == 0;
  if (cv::countNonZero(unseen) == 0) return bgr;
  if (bgr.data == image.pixels.data) bgr = bgr.clone();
  bgr.setTo(value, unseen);
  return bgr;
}

}  // namespace

NetworkPicture network_picture(const GroundImage& image, const NetworkDescription& network) {
  check(image);
  const auto& [red, green, blue] = network.mean;
  const cv::Scalar mean(blue, green, red);
  const double factor = image.gsd_m / network.gsd_m;
  NetworkPicture picture;
  picture.observed = resized(image.observed, factor, cv::Scalar::all(0));
  const auto up = [&](int side) { return (side + network.multiple - 1) / network.multiple * network.multiple; };
  const cv::Size size(up(picture.observed.cols), up(picture.observed.rows));
  picture.observed = padded(picture.observed, size, cv::Scalar::all(0));
  padded(resized(without_unseen(image, mean), factor, mean), size, mean).convertTo(picture.pixels, CV_32FC3);
  if (network.local_contrast) to_local_contrast(picture.pixels, picture.observed, *network.local_contrast);
  picture.pixels -= mean;
  picture.pixels /= cv::Scalar(network.std[2], network.std[1], network.std[0]);
  picture.pixels.setTo(cv::Scalar::all(0), picture.observed == 0);
  for (int i = 0; network.rgb && i < picture.pixels.rows; ++i) {  // of the whole, it would take a copy
    cv::Mat row = picture.pixels.row(i);
    cv::cvtColor(row, row, cv::COLOR_BGR2RGB);
  }
  return picture;
}

cv::Mat calibrated(const cv::Mat& output, const NetworkDescription& network) {
  cv::Mat logits;
  if (network.logits) {
    logits = output;
  } else {
    const cv::Mat p = cv::min(cv::max(output, 1e-6), 1.0 - 1e-6);
    cv::log(p / (1.0 - p), logits);
  }
  cv::Mat falling;
  cv::exp(-(logits * network.calibration_scale + network.calibration_bias), falling);
  return 1.0 / (1.0 + falling);
}

CellArray road_cells(const cv::Mat& probability, double step_m, const GroundImage& image, double cell_m) {
  const cv::Mat observed = observed_cells(image, cell_m);
  cv::Mat fine_seen = observed_cells(image, step_m);
  // Cells of the result may need a value from a fine cell of which less than half was seen.
  fine_seen.convertTo(fine_seen, CV_32F, 1.0 / 255.0, 1e-3);
  const cv::Mat seen = padded(fine_seen, probability.size(), cv::Scalar::all(1e-3))(cv::Rect({}, probability.size()));
  const double factor = step_m / cell_m;
  const cv::Mat weight = resized(seen, factor, cv::Scalar::all(0));
  const cv::Mat sum = resized(probability.mul(seen), factor, cv::Scalar::all(0));
  CellArray cells(observed.cols, observed.rows);
  for (int row = 0; row < observed.rows; ++row) {
    for (int col = 0; col < observed.cols; ++col) {
      if (observed.at<unsigned char>(row, col) == 0) continue;
      const double mass = static_cast<double>(weight.at<float>(row, col));
      const double p = mass > 0.0 ? static_cast<double>(sum.at<float>(row, col)) / mass : 0.0;
      cells.at(col, row) = cell_from_probability(p);
    }
  }
  return cells;
}

}  // namespace roadfix
