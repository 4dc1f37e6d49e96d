#include "cli/feature_input.hpp"

#include <vector>

#include "cli/detector_options.hpp"
#include "core/detect/image_codec.hpp"
#include "core/units/error.hpp"

namespace roadfix::cli {

void add_feature_input_options(CLI::App& command, FeatureInputOptions& o) {
  command.add_option("input", o.path, "Feature map (PNG: grey = probability of road, alpha = observed) or frame")
      ->required();
  auto* cell = command.add_option("--cell,--cell-m", o.cell_m, "The input is a feature map: its cell size in metres")
                   ->check(CLI::PositiveNumber);
  for (CLI::Option* frame : add_frame_options(command, o.frame)) frame->excludes(cell);
  command.add_option("--seed", o.seed, "Of detectors that draw random numbers")->capture_default_str();
  add_detector_options(command, o.detector);
}

FeatureInput read_feature_input(const FeatureInputOptions& options, double map_cell_m) {
  if (options.cell_m <= 0.0 && !options.frame.given()) {
    throw InvalidInput("input-kind-missing",
                       "say what the input is: --cell for a feature map, --gsd or --fov and --agl for a frame");
  }
  const std::vector<std::uint8_t> bytes = bytes_of(options.path);
  if (options.cell_m > 0.0) {
    return {FeatureMap::centred(decode_feature_map(bytes, kMostPixels), options.cell_m), {}};
  }
  const auto detector = make_detector(options.detector);
  const auto start = std::chrono::steady_clock::now();
  const GroundView view = ground_seen(options.frame, decode_image(bytes, kMostPixels), *detector);
  FeatureMap features = detect_features(*detector, view, map_cell_m, options.seed);
  return {std::move(features), std::chrono::steady_clock::now() - start};
}

}  // namespace roadfix::cli
