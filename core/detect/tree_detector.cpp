#include "core/detect/tree_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>
#include <utility>
#include <vector>

#include "core/detect/ground_scale.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr double kSmoothingPx = 1.0;  // sensor noise adds to B of (3) with every pixel

/// Unbiased enough for picking roots, and the same with every standard library.
std::size_t pick(std::mt19937_64& random, std::size_t below) { return static_cast<std::size_t>(random() % below); }

/// Cells of one tree, each named once.
class Tally {
 public:
  explicit Tally(TreeCounts& counts) : counts_(counts), last_tree_(counts.nodes.size(), CV_32SC1, cv::Scalar(-1)) {}

  void add(const RoadTree& tree, int id, double cells_per_px) {
    for (const TreeNode& node : tree.nodes) {
      const cv::Point cell(static_cast<int>((node.position.x + 0.5) * cells_per_px),
                           static_cast<int>((node.position.y + 0.5) * cells_per_px));
      if (!cv::Rect({}, counts_.nodes.size()).contains(cell)) continue;
      ++counts_.nodes.at<int>(cell);
      if (std::exchange(last_tree_.at<int>(cell), id) != id) ++counts_.trees.at<int>(cell);
    }
  }

 private:
  TreeCounts& counts_;
  cv::Mat last_tree_;
};

/// Share of road among cells that are reached `ratio` times as often as a cell is on average. Logistic fit over 1.3
/// million cells of labelled pairs of Massachusetts, Las Vegas, Shanghai and Japan (2 m cells, the default options):
/// 2 % at 0.1, 4 % at 1.4, 11 % at 3.1, 25 % at 5.1.
double road_probability(double ratio) {
  constexpr double kOffset = -3.98;
  constexpr double kSlope = 0.57;
  return 1.0 / (1.0 + std::exp(-(kOffset + kSlope * ratio)));
}

CellArray to_cells(const cv::Mat& observed, const auto& cell_at) {
  CellArray cells(observed.cols, observed.rows);
  for (int row = 0; row < cells.rows(); ++row) {
    for (int col = 0; col < cells.cols(); ++col) {
      if (observed.at<uchar>(row, col) != 0) cells.at(col, row) = cell_at(cv::Point(col, row));
    }
  }
  return cells;
}

}  // namespace

TreeCounts count_trees(const GroundImage& image, double cell_m, const TreeDetectorOptions& options, std::uint64_t seed,
                       const std::stop_token& stop) {
  const cv::Size cells = observed_cells(image, cell_m).size();
  TreeCounts counts{cv::Mat::zeros(cells, CV_32SC1), cv::Mat::zeros(cells, CV_32SC1)};
  const GroundImage ground = at_gsd(image, options.gsd_m);
  cv::Mat brightness;
  cv::GaussianBlur(brightness_of(ground.pixels), brightness, {}, kSmoothingPx);
  std::vector<cv::Point> open;
  cv::findNonZero(ground.observed, open);
  if (open.empty()) return counts;

  const double km2 = static_cast<double>(open.size()) * ground.gsd_m * ground.gsd_m / 1e6;
  const int trees = std::max(1, static_cast<int>(std::lround(options.trees_per_km2 * km2)));
  std::mt19937_64 random(seed);
  Tally tally(counts);
  for (int id = 0; id < trees; ++id) {
    require_not_interrupted(stop);
    const cv::Point root = open[pick(random, open.size())];
    tally.add(grow_tree(brightness, ground.observed, root, options.tree), id, ground.gsd_m / cell_m);
  }
  return counts;
}

TreeRoadDetector::TreeRoadDetector(const TreeDetectorOptions& options) : options_(options) {
  validate(options.tree);
  if (!(options.gsd_m > 0.0) || !(options.trees_per_km2 > 0.0) || options.min_nodes < 1) {
    throw InvalidInput(
        "tree-parameter",
        "tree detector: the ground sample distance, the trees per km2 and the node threshold must be positive");
  }
}

CellArray TreeRoadDetector::detect(const GroundImage& image, double cell_m, std::uint64_t seed,
                                   const std::stop_token& stop) const {
  const cv::Mat observed = observed_cells(image, cell_m);
  const TreeCounts counts = count_trees(image, cell_m, options_, seed, stop);
  if (options_.map == TreeDetectorOptions::Map::kBinary) {
    return to_cells(observed,
                    [&](cv::Point at) { return counts.nodes.at<int>(at) >= options_.min_nodes ? kRoad : kNoRoad; });
  }
  const double mean = cv::mean(counts.trees, observed)[0];
  return to_cells(observed, [&](cv::Point at) {
    return cell_from_probability(road_probability(mean > 0.0 ? counts.trees.at<int>(at) / mean : 0.0));
  });
}

double TreeRoadDetector::halo_m() const {
  // Trees of neighbouring blocks that reach in; half of the longest possible way covers nearly all of them.
  const double reach_px = options_.tree.max_nodes ? options_.tree.edge_px * std::sqrt(*options_.tree.max_nodes) : 200.0;
  return reach_px * options_.gsd_m;
}

std::string TreeRoadDetector::name() const { return fmt::format("tree map={}", word_of(kTreeMaps, options_.map)); }

std::string TreeRoadDetector::settings() const {
  const TreeParameters& t = options_.tree;
  const auto optional = [](const auto& value) { return value ? fmt::format("{}", *value) : std::string("-"); };
  return fmt::format(
      "trees_per_km2={} min_nodes={} alpha={} beta={} gamma={} epsilon={} edge_px={} fan={} "
      "fan_half_width_deg={:g} root_fan={} max_nodes={} max_explored_share={} max_area_px={} min_score={}",
      options_.trees_per_km2, options_.min_nodes, t.alpha, t.beta, t.gamma, t.epsilon, t.edge_px, t.fan,
      t.fan_half_width.degrees(), t.root_fan, optional(t.max_nodes), optional(t.max_explored_share),
      optional(t.max_area_px), optional(t.min_score));
}

}  // namespace roadfix
