// What `match` and `fix` take as input: a feature map as PNG, or a frame whose roads are detected first.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/frame_options.hpp"
#include "core/detect/make_detector.hpp"
#include "core/locate/map_view.hpp"

namespace roadfix::cli {

struct FeatureInputOptions {
  std::vector<std::string> also;        ///< FILE,FORWARD,RIGHT,TURN: more of the same kind, and where they were taken
  std::optional<double> cell_m;         ///< of feature maps that do not tell it themselves
  std::vector<double> nadir;            ///< of feature maps, where told: column and row
  std::optional<double> nadir_sigma_m;  ///< of each, where told: in place of what it says
  std::optional<double> nadir_heading_sigma_deg;
  FrameOptions frame;
  DetectorChoice detector;
};

inline constexpr const char* kInputMeaning = "Feature map (PNG: grey = probability of road, alpha = observed) or frame";

/// Adds all options but the input itself; `options` must live as long as the command.
void add_feature_input_options(CLI::App& command, FeatureInputOptions& options);

/// Reads inputs for a map. Without options of a frame these are feature maps.
class FeatureInput {
 public:
  /// Loads the detector that suits the map, for frames. Both arguments must outlive it.
  FeatureInput(const FeatureInputOptions& options, const MapView& map);

  /// Roads of a frame come in the map's cells; several frames (--also) are laid together. `takeoff_agl_m`: of photos,
  /// see KnownView. Throws InvalidInput "input-kind-missing" where a feature map does not say so itself and no option
  /// does. Says on standard error which of several were left out, and where another detector than reads frames found
  /// the roads of feature maps, once of each.
  api::Features read(const std::string& path, std::optional<double> takeoff_agl_m = {});

 private:
  api::Features features_in(const std::string& path, std::optional<double> takeoff_agl_m);
  FeatureMap feature_map_with_note(const std::string& path);

  const FeatureInputOptions& options_;
  const MapView& map_;
  std::shared_ptr<const RoadDetector> detector_;  ///< null for feature maps
  std::set<std::string> readers_;                 ///< of the feature maps
};

}  // namespace roadfix::cli
