// The paper's road detector: a tree that grows along directions of constant brightness, equations (1) to (3).
//
// From the unexpanded node with the highest score a fan of edges is proposed; the far ends become nodes. What the paper
// leaves open and we chose: scores start at 0 at the root, whose edges go all around; the cosine beyond 90 degrees is
// 0; B + epsilon stands for B; a place is entered once (each square of half an edge a side holds one node at most, so
// that nodes of neighbouring squares may lie close together).
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/units/angle.hpp"

namespace roadfix {

/// alpha, beta and gamma are the paper's. The rest was chosen for 0.5 m pixels by the area under the ROC curve over
/// labelled pairs of Massachusetts, Las Vegas, Shanghai and Japan.
struct TreeParameters {
  double alpha = 0.5;    ///< (1): weight of the new edge against the parent's score, in (0, 1)
  double beta = 0.8;     ///< (1): exponent of the cosine, above 0.7
  double gamma = 0.5;    ///< (2): weight of the new direction in the running mean, in (0, 1]
  double epsilon = 4.0;  ///< grey levels added to B of (3), above 0
  double edge_px = 12.0;
  int fan = 7;  ///< edges proposed from each node but the root
  Angle fan_half_width = Angle::degrees(40);
  int root_fan = 16;  ///< edges proposed from the root, all around

  // The four termination criteria; nullopt = not used. At least one of the first three must be set.
  std::optional<int> max_nodes = 200;
  std::optional<double> max_explored_share;  ///< explored pixels / observed pixels, in (0, 1]
  std::optional<double> max_area_px;         ///< of the tree: sum over edges of length x estimated road width
  std::optional<double> min_score;           ///< a new node below it is not added

  friend bool operator==(const TreeParameters&, const TreeParameters&) = default;
};

/// Throws InvalidInput ("tree-parameter") that names the parameter and its range.
void validate(const TreeParameters& parameters);

struct TreeNode {
  cv::Point2d position;  ///< pixels, x right, y down, integers at pixel centres
  Angle direction;       ///< theta of the edge from the parent, clockwise from the x axis
  Angle mean_direction;  ///< mtheta of (2)
  double score = 0.0;    ///< (1)
  int parent = -1;       ///< -1 for the root
};

enum class TreeEnd { kNodes, kExploredShare, kArea, kExhausted };

struct RoadTree {
  std::vector<TreeNode> nodes;  ///< the root first, parents before children
  TreeEnd end = TreeEnd::kExhausted;
};

/// Equation (3): total variation of brightness along the pixels of the segment, grey levels. nullopt when the segment
/// leaves the image or meets an unobserved pixel.
std::optional<double> brightness_variation(const cv::Mat& brightness, const cv::Mat& observed, cv::Point2d from,
                                           cv::Point2d to);

/// Equation (1).
double node_score(const TreeParameters& parameters, Angle direction, Angle parent_mean, double variation,
                  double parent_score);
/// Equation (2), along the shorter way around.
Angle running_mean(const TreeParameters& parameters, Angle direction, Angle parent_mean);

/// Both images CV_8UC1 of one size. The tree stays on observed pixels; a root on an unobserved one gives no nodes.
RoadTree grow_tree(const cv::Mat& brightness, const cv::Mat& observed, cv::Point root,
                   const TreeParameters& parameters);

}  // namespace roadfix
