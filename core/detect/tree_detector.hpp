// Feature maps from growing trees: the paper's binary map and a probabilistic one.
#pragma once

#include <array>

#include "core/detect/growing_tree.hpp"
#include "core/detect/road_detector.hpp"
#include "core/units/words.hpp"

namespace roadfix {

struct TreeDetectorOptions {
  enum class Map {
    kBinary,        ///< the paper's: 1 where a cell holds at least `min_nodes` nodes, else 0
    kProbabilistic  ///< from the share of the trees nearby that reach a cell
  };
  Map map = Map::kProbabilistic;
  double gsd_m = 0.5;           ///< brightness is resampled to it
  double trees_per_km2 = 3000;  ///< roots are drawn uniformly over the observed pixels
  int min_nodes = 3;            ///< binary map only
  TreeParameters tree;

  friend bool operator==(const TreeDetectorOptions&, const TreeDetectorOptions&) = default;
};

/// As options and the detector's settings name them.
inline constexpr std::array<Word<TreeDetectorOptions::Map>, 2> kTreeMaps{
    {{"probabilistic", TreeDetectorOptions::Map::kProbabilistic}, {"binary", TreeDetectorOptions::Map::kBinary}}};

/// Throws InvalidInput ("tree-parameter").
class TreeRoadDetector : public RoadDetector {
 public:
  explicit TreeRoadDetector(const TreeDetectorOptions& options = {});

  using RoadDetector::detect;
  CellArray detect(const GroundImage& image, double cell_m, std::uint64_t seed,
                   const std::stop_token& stop) const override;
  double preferred_gsd_m() const override { return options_.gsd_m; }
  double halo_m() const override;
  std::string name() const override;
  std::string settings() const override;

 private:
  TreeDetectorOptions options_;
};

/// Nodes that fall into it, and distinct trees that reach it. CV_32SC1, in the layout of
/// RoadDetector::detect.
struct TreeCounts {
  cv::Mat nodes;
  cv::Mat trees;
};
/// Throws Interrupted as RoadDetector::detect does.
TreeCounts count_trees(const GroundImage& image, double cell_m, const TreeDetectorOptions& options, std::uint64_t seed,
                       const std::stop_token& stop = {});

}  // namespace roadfix
