// The one place where a user's choice of detector becomes a detector: ingest, detect and, by Detectors, fix, fly,
// bench and the service call it.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/detect/model_files.hpp"
#include "core/detect/road_detector.hpp"
#include "core/detect/tree_detector.hpp"

namespace roadfix {

struct DetectorChoice {
  std::string name = "auto";    ///< one of kDetectorNames
  std::filesystem::path model;  ///< ONNX file of the neural detector; empty = the shipped ones
  /// NeuralOptions::orientations; nullopt = the usual ones: kMapOrientations of maps, one of frames
  std::optional<int> orientations{};
  TreeDetectorOptions tree;

  friend bool operator==(const DetectorChoice&, const DetectorChoice&) = default;
};

/// A map is made once, and without haste: in four orientations it gives more fixes (docs/experiments.md).
inline constexpr int kMapOrientations = 4;

/// "auto": neural where `model` is named or default_model() finds one, else the tree.
inline constexpr std::array<const char*, 3> kDetectorNames{"auto", "neural", "tree"};

/// Whether it is left to default_model() which network reads.
bool is_left_to_default(const DetectorChoice& choice);

/// note_on_missing_network(), where that matters to the choice.
std::optional<std::string> note_on_missing_network(const DetectorChoice& choice);

/// InvalidInput "unknown-detector", "model-missing" (no weights found), "model-without-network",
/// "option-without-effect" (of the other detector) and those of the detectors' constructors.
std::unique_ptr<RoadDetector> make_detector(const DetectorChoice& choice, SourceContent compared);

/// The same, for the imagery of a map.
std::unique_ptr<RoadDetector> make_map_detector(DetectorChoice choice);

}  // namespace roadfix
