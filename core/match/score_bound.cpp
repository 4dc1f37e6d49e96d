#include "core/match/score_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roadfix {
namespace {

constexpr double kRounding = 1e-6;  // sums are exact but for their last digits

/// Score <= (cross - slope * map) / root for one of the ends, whichever branch is taken: map variance is at least
/// concave(map) = a map + b - map^2 / n for two choices of (a, b), so that slope * map + score * root is least at an
/// end.
struct Ends {
  std::array<double, 2> slope_map{};
  std::array<double, 2> root{};  ///< 0 if nothing is known
};

struct Problem {
  bool possible = false;
  double cap = 0.0;  ///< Pearson is at most 1
  std::array<Ends, 2> branches{};
};

Problem prepared(const BlockSums& s, double full_cells, double min_cells) {
  Problem problem;
  if (s.cells.max <= 0.0 || s.cells.max < min_cells || s.map.max <= 0.0) return problem;
  problem.possible = true;
  problem.cap = std::sqrt(s.cells.max / full_cells);
  const double n_min = std::max(1.0, s.cells.min);
  const double mean_min = s.feature.min / s.cells.max;
  const double feature_spread = s.feature_square_min - s.feature.max * s.feature.max / n_min;
  // score = (S_ml - S_l S_m / n) / sqrt(V_m V_l) * sqrt(n / full), and S_ml - S_l S_m / n
  //       <= cross - (S_l / n - base) S_m
  const double slope = mean_min - s.base;
  const double gain = problem.cap;
  const double mixed = s.span * s.map.max - s.map_square.max;  // of m (span - m), at most: see below
  const std::array<double, 2> factor{0.0, s.span};
  const std::array<double, 2> offset{s.map_square.min, -mixed};
  const std::array<double, 2> ends{s.map.min, s.map.max};
  for (std::size_t branch = 0; branch < 2; ++branch) {
    std::array<double, 2> spread{};
    for (std::size_t end = 0; end < 2; ++end) {
      spread[end] = factor[branch] * ends[end] + offset[branch] - ends[end] * ends[end] / n_min;
    }
    const bool known = feature_spread > 0.0 && spread[0] > 0.0 && spread[1] > 0.0;
    for (std::size_t end = 0; end < 2; ++end) {
      // A negative slope counts map roads in favour: then the most of them, at either end.
      problem.branches[branch].slope_map[end] = slope * (slope >= 0.0 ? ends[end] : s.map.max);
      problem.branches[branch].root[end] = known ? std::sqrt(feature_spread * spread[end]) / gain : 0.0;
    }
  }
  return problem;
}

}  // namespace

double score_bound(const BlockSums& sums, double full_cells, double min_cells) {
  const Problem problem = prepared(sums, full_cells, min_cells);
  if (!problem.possible) return 0.0;
  double bound = problem.cap;
  for (const Ends& ends : problem.branches) {
    double max = 0.0;
    for (std::size_t end = 0; end < 2; ++end) {
      const double cross = sums.cross_max - ends.slope_map[end];
      if (cross > 0.0) max = std::max(max, ends.root[end] > 0.0 ? cross / ends.root[end] : problem.cap);
    }
    bound = std::min(bound, max);
  }
  return bound * (1.0 + kRounding);
}

double cross_needed(const BlockSums& sums, double full_cells, double min_cells, double score) {
  const Problem problem = prepared(sums, full_cells, min_cells);
  if (!problem.possible || problem.cap * (1.0 + kRounding) < score) return std::numeric_limits<double>::infinity();
  double needed = 0.0;
  for (const Ends& ends : problem.branches) {
    double min = std::numeric_limits<double>::infinity();
    for (std::size_t end = 0; end < 2; ++end) {
      min = std::min(min, ends.slope_map[end] + score / (1.0 + kRounding) * ends.root[end]);
    }
    needed = std::max(needed, min);
  }
  return needed;
}

}  // namespace roadfix
