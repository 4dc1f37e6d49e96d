#include "core/detect/make_detector.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/detect/neural_detector.hpp"
#include "core/units/error.hpp"

namespace roadfix {

bool is_left_to_default(const DetectorChoice& choice) { return choice.name != "tree" && choice.model.empty(); }

std::optional<std::string> note_on_missing_network(const DetectorChoice& choice) {
  return is_left_to_default(choice) ? note_on_missing_network() : std::nullopt;
}

std::unique_ptr<RoadDetector> make_detector(const DetectorChoice& choice, SourceContent compared) {
  if (std::ranges::find(kDetectorNames, choice.name) == kDetectorNames.end()) {
    throw InvalidInput("unknown-detector", fmt::format("\"{}\" is not a detector: choose one of {}.", choice.name,
                                                       fmt::join(kDetectorNames, ", ")));
  }
  if (choice.name == "tree") {
    if (!choice.model.empty()) {
      throw InvalidInput("model-without-network", "A model was named for the tree detector, which needs none.");
    }
    if (choice.orientations) {
      throw InvalidInput("option-without-effect",
                         "--orientations does nothing with the tree detector, which has no network: leave it out.");
    }
    return std::make_unique<TreeRoadDetector>(choice.tree);
  }
  const auto model = choice.model.empty() ? default_model(compared) : choice.model;
  if (!model && choice.name == "auto") return std::make_unique<TreeRoadDetector>(choice.tree);
  if (!model) {
    throw InvalidInput("model-missing",
                       "No weights of the road network were found. Name them with --model FILE.onnx or ROADFIX_MODEL.");
  }
  if (choice.tree != TreeDetectorOptions()) {
    throw InvalidInput("option-without-effect",
                       "--tree-... does nothing with the neural detector: give --detector tree, or leave it out.");
  }
  return std::make_unique<NeuralRoadDetector>(
      *model, NeuralOptions{choice.orientations.value_or(NeuralOptions().orientations)});
}

std::unique_ptr<RoadDetector> make_map_detector(DetectorChoice choice) {
  if (choice.name != "tree" && !choice.orientations) choice.orientations = kMapOrientations;
  return make_detector(choice, SourceContent::kImagery);
}

}  // namespace roadfix
