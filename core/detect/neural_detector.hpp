// Road probability by a convolutional network.
#pragma once

#include <array>
#include <filesystem>
#include <memory>

#include "core/detect/network_description.hpp"
#include "core/detect/road_detector.hpp"

namespace roadfix {

class Network;

/// The picture as it is, in all quarter turns, and in these mirrored as well.
inline constexpr std::array kOrientations{1, 4, 8};

struct NeuralOptions {
  /// In how many orientations of the picture the network runs; the result is their mean. One of kOrientations. Takes
  /// that many times as long: more than one is for maps, which are not made in real time.
  int orientations = 1;
};

/// Any picture size, by overlapping tiles with blended borders. The picture is brought to the network's ground sample
/// distance; unobserved pixels reach the network as its mean and never the result. Ignores the seed.
class NeuralRoadDetector : public RoadDetector {
 public:
  /// Loads `model` (ONNX, input 1 x 3 x H x W, output 1 x 1 x H/stride x W/stride) and the JSON beside it.
  /// InvalidInput: "model-missing", "model-unreadable" (not an ONNX that OpenCV knows), "model-description",
  /// "model-shape" (another input or output), "model-checksum".
  explicit NeuralRoadDetector(const std::filesystem::path& model, const NeuralOptions& options = {});
  ~NeuralRoadDetector() override;

  using RoadDetector::detect;
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t seed,
                   const std::stop_token& stop) const override;
  double preferred_gsd_m() const override;
  double halo_m() const override;
  std::string name() const override;
  std::string settings() const override;

 private:
  void check_shape(const std::filesystem::path& model) const;
  /// The network's output for a NetworkPicture's `pixels` and `observed`.
  cv::Mat answer_to(const cv::Mat& pixels, const cv::Mat& observed, const std::stop_token& stop) const;

  NetworkDescription network_;
  NeuralOptions options_;
  std::string checksum_;
  std::unique_ptr<Network> runner_;
};

}  // namespace roadfix
