#include "core/detect/growing_tree.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <queue>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

void require_parameter(bool condition, const char* parameter, const char* range) {
  if (!condition)
    throw InvalidInput("tree-parameter", fmt::format("tree detector: {} must lie in {}", parameter, range));
}

bool is_open(const cv::Mat& observed, cv::Point p) {
  return p.x >= 0 && p.y >= 0 && p.x < observed.cols && p.y < observed.rows && observed.at<uchar>(p) != 0;
}

cv::Point pixel_of(cv::Point2d p) { return {static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y))}; }

/// Width of the strip across the direction that is about as bright as its middle.
double road_width(const cv::Mat& brightness, const cv::Mat& observed, const TreeNode& node) {
  constexpr int kTolerance = 20;  // grey levels
  constexpr int kReachPx = 15;
  const int middle = brightness.at<uchar>(pixel_of(node.position));
  const cv::Point2d across(-sin(node.direction), cos(node.direction));
  double width = 1.0;
  for (const double side : {-1.0, 1.0}) {
    for (int k = 1; k <= kReachPx; ++k) {
      const cv::Point p = pixel_of(node.position + side * k * across);
      if (!is_open(observed, p) || std::abs(brightness.at<uchar>(p) - middle) > kTolerance) break;
      width += 1.0;
    }
  }
  return width;
}

/// One tree while it grows.
class Growth {
 public:
  Growth(const cv::Mat& brightness, const cv::Mat& observed, const TreeParameters& parameters)
      : brightness_(brightness),
        observed_(observed),
        parameters_(parameters),
        cell_px_(std::max(1.0, parameters.edge_px / 2.0)),
        taken_(zeros(place_of({brightness.cols - 1.0, brightness.rows - 1.0}) + cv::Point(2, 2))) {
    if (parameters.max_explored_share) observed_px_ = cv::countNonZero(observed);
  }

  RoadTree grow(cv::Point root) {
    if (!is_open(observed_, root)) return {};
    add({cv::Point2d(root), {}, {}, 0.0, -1}, 0.0);
    while (!unexpanded_.empty()) {
      if (const auto end = ended()) {
        tree_.end = *end;
        break;
      }
      const int best = unexpanded_.top().second;
      unexpanded_.pop();
      expand(best);
    }
    return std::move(tree_);
  }

 private:
  static cv::Mat zeros(cv::Point size) { return cv::Mat::zeros(size.y, size.x, CV_8UC1); }
  cv::Point place_of(cv::Point2d p) const {
    return {static_cast<int>((p.x + 0.5) / cell_px_), static_cast<int>((p.y + 0.5) / cell_px_)};
  }

  void expand(int parent) {
    const bool is_root = parent == 0;
    const int edges = is_root ? parameters_.root_fan : parameters_.fan;
    for (int k = 0; k < edges && !node_limit_reached(); ++k) {
      const Angle mean = tree_.nodes[static_cast<std::size_t>(parent)].mean_direction;
      propose(parent, is_root ? (k * 2.0 / edges) * Angle::radians(std::numbers::pi) : mean + fan_offset(k));
    }
  }

  Angle fan_offset(int k) const {
    if (parameters_.fan == 1) return {};
    return (2.0 * k / (parameters_.fan - 1) - 1.0) * parameters_.fan_half_width;
  }

  void propose(int parent_index, Angle direction) {
    const TreeNode parent = tree_.nodes[static_cast<std::size_t>(parent_index)];
    const cv::Point2d end = parent.position + parameters_.edge_px * cv::Point2d(cos(direction), sin(direction));
    if (!is_open(observed_, pixel_of(end)) || taken_.at<uchar>(place_of(end)) != 0) return;
    const auto variation = brightness_variation(brightness_, observed_, parent.position, end);
    if (!variation) return;
    const Angle parent_mean = parent_index == 0 ? direction : parent.mean_direction;
    TreeNode node;
    node.position = end;
    node.direction = direction;
    node.parent = parent_index;
    node.score = node_score(parameters_, direction, parent_mean, *variation, parent.score);
    node.mean_direction = running_mean(parameters_, direction, parent_mean);
    if (parameters_.min_score && node.score < *parameters_.min_score) return;
    add(node, parameters_.edge_px);
  }

  void add(const TreeNode& node, double edge_px) {
    if (parameters_.max_area_px) area_px_ += edge_px * road_width(brightness_, observed_, node);
    explored_px_ += cell_px_ * cell_px_;
    taken_.at<uchar>(place_of(node.position)) = 1;
    unexpanded_.emplace(node.score, static_cast<int>(tree_.nodes.size()));
    tree_.nodes.push_back(node);
  }

  bool node_limit_reached() const {
    return parameters_.max_nodes && static_cast<int>(tree_.nodes.size()) >= *parameters_.max_nodes;
  }

  std::optional<TreeEnd> ended() const {
    if (node_limit_reached()) return TreeEnd::kNodes;
    if (parameters_.max_explored_share && explored_px_ >= *parameters_.max_explored_share * observed_px_) {
      return TreeEnd::kExploredShare;
    }
    if (parameters_.max_area_px && area_px_ >= *parameters_.max_area_px) return TreeEnd::kArea;
    return std::nullopt;
  }

  const cv::Mat& brightness_;
  const cv::Mat& observed_;
  const TreeParameters& parameters_;
  double cell_px_;
  cv::Mat taken_;
  double observed_px_ = 0.0;
  double explored_px_ = 0.0;
  double area_px_ = 0.0;
  std::priority_queue<std::pair<double, int>> unexpanded_;
  RoadTree tree_;
};

}  // namespace

void validate(const TreeParameters& p) {
  require_parameter(p.alpha > 0.0 && p.alpha < 1.0, "alpha", "(0, 1)");
  require_parameter(p.beta > 0.7 && p.beta <= 100.0, "beta", "(0.7, 100]");
  require_parameter(p.gamma > 0.0 && p.gamma <= 1.0, "gamma", "(0, 1]");
  require_parameter(p.epsilon > 0.0 && p.epsilon <= 255.0, "epsilon", "(0, 255]");
  require_parameter(p.edge_px >= 2.0 && p.edge_px <= 1000.0, "edge length", "[2, 1000] pixels");
  require_parameter(p.fan >= 1 && p.fan <= 360, "fan", "[1, 360]");
  require_parameter(p.root_fan >= 1 && p.root_fan <= 360, "root fan", "[1, 360]");
  require_parameter(p.fan_half_width.degrees() >= 0.0 && p.fan_half_width.degrees() <= 180.0, "fan half width",
                    "[0, 180] degrees");
  require_parameter(!p.max_nodes || *p.max_nodes >= 1, "number of nodes", "[1, ...)");
  require_parameter(!p.max_explored_share || (*p.max_explored_share > 0.0 && *p.max_explored_share <= 1.0),
                    "explored share", "(0, 1]");
  require_parameter(!p.max_area_px || *p.max_area_px > 0.0, "area", "(0, ...) pixels");
  require_parameter(!p.min_score || (*p.min_score >= 0.0 && *p.min_score <= 1.0 / p.epsilon), "minimum score",
                    "[0, 1 / epsilon]");
  require_parameter(p.max_nodes || p.max_explored_share || p.max_area_px, "one of nodes, explored share and area",
                    "use");
}

std::optional<double> brightness_variation(const cv::Mat& brightness, const cv::Mat& observed, cv::Point2d from,
                                           cv::Point2d to) {
  const cv::Point2d way = to - from;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::max(std::abs(way.x), std::abs(way.y)))));
  int total = 0;
  int previous = -1;
  for (int k = 0; k <= steps; ++k) {
    const cv::Point p = pixel_of(from + (static_cast<double>(k) / steps) * way);
    if (!is_open(observed, p)) return std::nullopt;
    const int level = brightness.at<uchar>(p);
    if (previous >= 0) total += std::abs(level - previous);  // (3)
    previous = level;
  }
  return total;
}

double node_score(const TreeParameters& p, Angle direction, Angle parent_mean, double variation, double parent_score) {
  const double bend = cos(angular_distance(direction, parent_mean));
  const double along = bend > 0.0 ? std::pow(bend, p.beta) : 0.0;
  return p.alpha * along / (variation + p.epsilon) + (1.0 - p.alpha) * parent_score;  // (1)
}

Angle running_mean(const TreeParameters& p, Angle direction, Angle parent_mean) {
  return (parent_mean + p.gamma * (direction - parent_mean).wrapped()).wrapped();  // (2)
}

RoadTree grow_tree(const cv::Mat& brightness, const cv::Mat& observed, cv::Point root,
                   const TreeParameters& parameters) {
  return Growth(brightness, observed, parameters).grow(root);
}

}  // namespace roadfix
