#include "cli/detector_options.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "cli/number_checks.hpp"
#include "cli/unit_options.hpp"
#include "cli/word_option.hpp"
#include "core/detect/neural_detector.hpp"

namespace roadfix::cli {

namespace {

constexpr double kMaxTrees = 1e6;   ///< per km2: one on each square metre
constexpr double kMaxNodes = 1e6;   ///< of a tree, or of a cell
constexpr double kMaxAreaPx = 1e9;  ///< more than any picture has
constexpr double kMaxGsdM = 100.0;

/// Everything that method and paper leave to the user of the growing tree. What has no limit here has one of the tree.
void add_tree_options(CLI::App& command, TreeDetectorOptions& o) {
  constexpr const char* kGroup = "Growing tree (--detector tree)";
  const auto add = [&](const char* name, auto& value, const char* what) {
    return command.add_option(name, value, what)->group(kGroup);
  };
  add_word_option(command, "--tree-map", kTreeMaps, o.map,
                  "probabilistic (default) or binary: the paper's, by --tree-min-nodes")
      ->group(kGroup);
  add("--tree-gsd", o.gsd_m, "Metres per pixel of the brightness; default: 0.5")->check(positive(kMaxGsdM));
  add("--tree-roots", o.trees_per_km2, "Trees per km2; default: 3000")->check(positive(kMaxTrees));
  add("--tree-min-nodes", o.min_nodes, "Nodes that make a cell of the binary map road; default: 3")
      ->check(positive(kMaxNodes));
  add("--tree-alpha", o.tree.alpha, "Equation (1): weight of the new edge; default: 0.5");
  add("--tree-beta", o.tree.beta, "Equation (1): exponent of the cosine, above 0.7; default: 0.8");
  add("--tree-gamma", o.tree.gamma, "Equation (2): weight of the new direction; default: 0.5");
  add("--tree-epsilon", o.tree.epsilon, "Grey levels added to B of equation (3); default: 4");
  add("--tree-edge", o.tree.edge_px, "Length of an edge in pixels; default: 12");
  add("--tree-fan", o.tree.fan, "Edges proposed from a node; default: 7");
  add_degrees_option(command, "--tree-fan-width", o.tree.fan_half_width,
                     "Half the angle of the fan in degrees; default: 40")
      ->group(kGroup);
  add("--tree-root-fan", o.tree.root_fan, "Edges proposed from the root, all around; default: 16");
  const auto* nodes = add("--tree-nodes", o.tree.max_nodes,
                          "End of a tree: number of nodes; default: 200, or none where another end is given")
                          ->check(positive(kMaxNodes));
  // Trees of so many nodes would hardly ever come to another end.
  const auto add_end = [&](const char* name, std::optional<double>& end, const char* what) {
    const auto take = [&o, &end, nodes](double value) {
      end = value;
      if (nodes->empty()) o.tree.max_nodes.reset();
    };
    return command.add_option_function<double>(name, take, what)->group(kGroup);
  };
  add_end("--tree-explored", o.tree.max_explored_share, "End of a tree: explored share of the picture");
  add_end("--tree-area", o.tree.max_area_px, "End of a tree: its estimated area in pixels")
      ->check(positive(kMaxAreaPx));
  add("--tree-min-score", o.tree.min_score, "End of a branch: score of a new node");
}

}  // namespace

CLI::Validator orientations() { return CLI::IsMember(std::vector<int>(kOrientations.begin(), kOrientations.end())); }

void add_detector_options(CLI::App& command, DetectorChoice& choice, int usual_orientations) {
  command
      .add_option("--detector", choice.name,
                  "Road detector: neural (a network), tree (the paper's growing tree), or auto (neural where its "
                  "weights are found, else tree)")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(kDetectorNames.begin(), kDetectorNames.end())));
  command.add_option("--model", choice.model, "ONNX file of the neural detector, with its JSON beside it")
      ->type_name("FILE");
  command
      .add_option(
          "--orientations", choice.orientations,
          fmt::format("1, 4 or 8: mean over turned and mirrored copies of the picture; slower, better (default: "
                      "{})",
                      usual_orientations))
      ->check(orientations());
  add_tree_options(command, choice.tree);
}

}  // namespace roadfix::cli
