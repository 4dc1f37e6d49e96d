// What the detector must know about a network besides its ONNX file: the JSON document next to it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace roadfix {

/// Each channel minus the mean of grey, over the standard deviation of grey plus `floor` (grey levels), both over the
/// seen pixels of a square window around the pixel: a dark or hazy picture looks like any other.
struct LocalContrast {
  int window_px = 129;  ///< odd
  double floor = 4.0;
};

/// Lengths named _px are pixels of the network's input, whose size on the ground is `gsd_m`.
struct NetworkDescription {
  std::string name;
  double gsd_m = 1.0;
  int stride = 2;     ///< one output cell covers stride x stride input pixels
  int multiple = 16;  ///< the sides of the input are multiples of this
  int tile_px = 384;
  int overlap_px = 96;                          ///< of neighbouring tiles
  bool rgb = true;                              ///< order of the input's channels; false = BGR
  std::optional<LocalContrast> local_contrast;  ///< comes before `mean` and `std`
  std::array<double, 3> mean{};                 ///< in the order red, green, blue, grey levels 0 to 255
  std::array<double, 3> std{1.0, 1.0, 1.0};
  bool logits = true;  ///< false = the output is a probability
  /// Calibration: probability = 1 / (1 + exp(-(scale * logit + bias))).
  double calibration_scale = 1.0;
  double calibration_bias = 0.0;
  std::string fnv1a64;  ///< of the ONNX file, as core/units/fnv.hpp gives it; empty = not stated
};

/// Throws InvalidInput "model-description" with the field and its range.
NetworkDescription parse_network_description(std::string_view json);

/// Description of `model`.onnx from `model`.json. Throws InvalidInput "model-description" where there is none.
NetworkDescription read_network_description(const std::filesystem::path& model);

}  // namespace roadfix
