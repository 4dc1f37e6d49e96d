#include "core/detect/neural_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "core/detect/network_picture.hpp"
#include "core/detect/tiling.hpp"
#include "core/network/network.hpp"
#include "core/units/bytes.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/fnv.hpp"

namespace roadfix {
namespace {

std::string read_model(const std::filesystem::path& model) {
  auto bytes = read_file(model);
  if (!bytes) {
    throw InvalidInput("model-missing", fmt::format("{} cannot be read. Name an ONNX file with --model, or use "
                                                    "--detector tree, which needs none.",
                                                    model.string()));
  }
  return *std::move(bytes);
}

cv::Mat mirrored(const cv::Mat& picture) {
  cv::Mat result;
  cv::flip(picture, result, 1);
  return result;
}

cv::Mat turned(const cv::Mat& picture, int quarters) {
  if (quarters == 0) return picture;
  cv::Mat result;
  cv::rotate(picture, result, quarters - 1);
  return result;
}

/// OpenCV breaks the lines of its messages.
std::string in_one_line(std::string message) {
  std::ranges::replace(message, '\n', ' ');
  return message;
}

/// The picture mirrored (k >= 4) and then turned by k % 4 quarters; `upright` takes it back.
cv::Mat oriented(const cv::Mat& picture, int k) { return turned(k >= 4 ? mirrored(picture) : picture, k % 4); }

cv::Mat upright(const cv::Mat& picture, int k) {
  const cv::Mat back = turned(picture, (4 - k % 4) % 4);
  return k >= 4 ? mirrored(back) : back;
}

}  // namespace

NeuralRoadDetector::NeuralRoadDetector(const std::filesystem::path& model, const NeuralOptions& options)
    : options_(options) {
  assert(std::ranges::find(kOrientations, options.orientations) != kOrientations.end());
  const std::string onnx = read_model(model);
  network_ = read_network_description(model);
  checksum_ = roadfix::fnv1a64(onnx);
  if (!network_.fnv1a64.empty() && network_.fnv1a64 != checksum_) {
    throw InvalidInput("model-checksum", fmt::format("{} has the checksum {}, its description says {}: they are not of "
                                                     "one export.",
                                                     model.string(), checksum_, network_.fnv1a64));
  }
  try {
    runner_ = load_network(bytes_of(onnx));
  } catch (const cv::Exception& error) {
    throw InvalidInput("model-unreadable", fmt::format("{} is not an ONNX network that OpenCV {} runs (export with "
                                                       "opset 11): {}",
                                                       model.string(), CV_VERSION, in_one_line(error.err)));
  }
  check_shape(model);
}

void NeuralRoadDetector::check_shape(const std::filesystem::path& model) const {
  const cv::Size sample(4 * network_.multiple, 3 * network_.multiple);
  const cv::Size expected(sample.width / network_.stride, sample.height / network_.stride);
  std::string found;
  try {
    const cv::Size size = runner_->output_size(sample);
    if (size == expected) return;
    found = fmt::format("{} x {} cells", size.width, size.height);
  } catch (const cv::Exception& error) {
    found = in_one_line(error.err);
  }
  throw InvalidInput("model-shape",
                     fmt::format("{}: for an input of 1 x 3 x {} x {} the output must be 1 x 1 x {} x {} "
                                 "(stride {}), but: {}.",
                                 model.string(), sample.height, sample.width, expected.height, expected.width,
                                 network_.stride, found));
}

NeuralRoadDetector::~NeuralRoadDetector() = default;

CellArray NeuralRoadDetector::detect(const GroundImage& image, double cell_m, std::uint64_t /*seed*/,
                                     const std::stop_token& stop) const {
  const NetworkPicture picture = network_picture(image, network_);
  cv::Mat mean;
  for (int k = 0; k < options_.orientations; ++k) {
    const cv::Mat answer = upright(answer_to(oriented(picture.pixels, k), oriented(picture.observed, k), stop), k);
    mean = mean.empty() ? answer.clone() : cv::Mat(mean + answer);
  }
  mean /= options_.orientations;
  return road_cells(calibrated(mean, network_), network_.gsd_m * network_.stride, image, cell_m);
}

cv::Mat NeuralRoadDetector::answer_to(const cv::Mat& pixels, const cv::Mat& observed,
                                      const std::stop_token& stop) const {
  const TilePlan plan{network_.tile_px, network_.overlap_px, network_.stride, network_.multiple};
  return blend_tiles(observed, plan, [&](const cv::Rect& tile) {
    require_not_interrupted(stop);
    return runner_->run(pixels(tile));
  });
}

double NeuralRoadDetector::preferred_gsd_m() const { return network_.gsd_m; }

double NeuralRoadDetector::halo_m() const {
  // Local contrast at a block's edge sees a part of its window: that moves a probability far less than what it costs to
  // run the network on the window's other half.
  return 0.5 * network_.overlap_px * network_.gsd_m;
}

std::string NeuralRoadDetector::name() const { return fmt::format("neural {} fnv1a64={}", network_.name, checksum_); }

std::string NeuralRoadDetector::settings() const { return fmt::format("orientations={}", options_.orientations); }

}  // namespace roadfix
