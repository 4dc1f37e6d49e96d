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

Problem prepared(const BlockSums& s, double full_cells, double least_cells) {
  Problem problem;
  if (s.cells.most <= 0.0 || s.cells.most < least_cells || s.map.most <= 0.0) return problem;
  problem.possible = true;
  problem.cap = std::sqrt(s.cells.most / full_cells);
  const double least = std::max(1.0, s.cells.least);
  const double mean_least = s.feature.least / s.cells.most;
  const double feature_spread = s.feature_square_least - s.feature.most * s.feature.most / least;
  // score = (S_ml - S_l S_m / n) / sqrt(V_m V_l) * sqrt(n / full), and S_ml - S_l S_m / n
  //       <= cross - (S_l / n - base) S_m
  const double slope = mean_least - s.base;
  const double gain = problem.cap;
  const double mixed = s.span * s.map.most - s.map_square.most;  // of m (span - m), at most: see below
  const std::array<double, 2> factor{0.0, s.span};
  const std::array<double, 2> offset{s.map_square.least, -mixed};
  const std::array<double, 2> ends{s.map.least, s.map.most};
  for (std::size_t branch = 0; branch < 2; ++branch) {
    std::array<double, 2> spread{};
    for (std::size_t end = 0; end < 2; ++end) {
      spread[end] = factor[branch] * ends[end] + offset[branch] - ends[end] * ends[end] / least;
    }
    const bool known = feature_spread > 0.0 && spread[0] > 0.0 && spread[1] > 0.0;
    for (std::size_t end = 0; end < 2; ++end) {
      // A negative slope counts map roads in favour: then the most of them, at either end.
      problem.branches[branch].slope_map[end] = slope * (slope >= 0.0 ? ends[end] : s.map.most);
      problem.branches[branch].root[end] = known ? std::sqrt(feature_spread * spread[end]) / gain : 0.0;
    }
  }
  return problem;
}

}  // namespace

double score_bound(const BlockSums& sums, double full_cells, double least_cells) {
  const Problem problem = prepared(sums, full_cells, least_cells);
  if (!problem.possible) return 0.0;
  double bound = problem.cap;
  for (const Ends& ends : problem.branches) {
    double most = 0.0;
    for (std::size_t end = 0; end < 2; ++end) {
      const double cross = sums.cross_most - ends.slope_map[end];
      if (cross > 0.0) most = std::max(most, ends.root[end] > 0.0 ? cross / ends.root[end] : problem.cap);
    }
    bound = std::min(bound, most);
  }
  return bound * (1.0 + kRounding);
}

double cross_needed(const BlockSums& sums, double full_cells, double least_cells, double score) {
  const Problem problem = prepared(sums, full_cells, least_cells);
  if (!problem.possible || problem.cap * (1.0 + kRounding) < score) return std::numeric_limits<double>::infinity();
  double needed = 0.0;
  for (const Ends& ends : problem.branches) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t end = 0; end < 2; ++end) {
      least = std::min(least, ends.slope_map[end] + score / (1.0 + kRounding) * ends.root[end]);
    }
    needed = std::max(needed, least);
  }
  return needed;
}

}  // namespace roadfix
