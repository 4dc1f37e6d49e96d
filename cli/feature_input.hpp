// What `match` and `fix` take as input: a feature map as PNG, or a frame whose roads are detected first.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/frame_options.hpp"
#include "core/detect/make_detector.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix::cli {

struct FeatureInputOptions {
  std::string path;
  std::vector<std::string> also;        ///< FILE,FORWARD,RIGHT,TURN: more of the same kind, and where they were taken
  std::optional<double> cell_m;         ///< of feature maps that do not tell it themselves
  std::vector<double> nadir;            ///< of feature maps, where told: column and row
  std::optional<double> nadir_sigma_m;  ///< of each, where told: in place of what it says
  std::optional<double> nadir_heading_sigma_deg;
  FrameOptions frame;
  std::uint64_t seed = 1;
  DetectorChoice detector;
};

/// Adds the input file and its options; `options` must live as long as the command.
void add_feature_input_options(CLI::App& command, FeatureInputOptions& options);

/// Roads of a frame come in the map's cells, by the detector that suits the map; several frames are laid together.
/// Without options of a frame the input is a feature map. Throws InvalidInput "input-kind-missing" where it does not
/// say so itself and no option does.
api::Features read_feature_input(const FeatureInputOptions& options, const MapView& map);

}  // namespace roadfix::cli
