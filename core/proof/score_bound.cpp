#include "core/proof/score_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roadfix {
namespace {

constexpr double kRounding = 1e-6;  // sums are exact but for their last digits

/// Of one bound on V_m, at the two ends of S_m: cross >= slope_map + score * root for any pose that scores so much at
/// that end.
struct Ends {
  std::array<double, 2> slope_map{};  ///< (mean - base) S_m
  std::array<double, 2> root{};       ///< sqrt(V_l V_m full / n); 0 where nothing is known
};

struct Bounds {
  bool possible = false;  ///< else no pose has a score
  double cap = 0.0;       ///< of scores, since Pearson is at most 1
  std::array<Ends, 2> map_variance{};
};

Bounds bounds_of(const BlockSums& s, const FootprintCells& footprint) {
  Bounds bounds;
  if (s.cells.max <= 0.0 || s.cells.max < footprint.min || s.map.max <= 0.0) return bounds;
  bounds.possible = true;
  bounds.cap = std::sqrt(s.cells.max / static_cast<double>(footprint.full));
  const double n_min = std::max(1.0, s.cells.min);
  const double slope = s.feature.min / s.cells.max - s.base;
  const double feature_variance = s.feature_square_min - s.feature.max * s.feature.max / n_min;
  const std::array<double, 2> a{0.0, s.span};
  const std::array<double, 2> b{s.map_square_min, -s.map_mixed_max};
  const std::array<double, 2> map{s.map.min, s.map.max};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto variance_at = [&](double map_sum) { return a[i] * map_sum + b[i] - map_sum * map_sum / n_min; };
    const std::array<double, 2> variance{variance_at(map[0]), variance_at(map[1])};
    const bool known = feature_variance > 0.0 && variance[0] > 0.0 && variance[1] > 0.0;
    for (std::size_t end = 0; end < 2; ++end) {
      // A negative slope counts map roads in favour: then the most of them, at either end.
      bounds.map_variance[i].slope_map[end] = slope * (slope >= 0.0 ? map[end] : s.map.max);
      bounds.map_variance[i].root[end] = known ? std::sqrt(feature_variance * variance[end]) / bounds.cap : 0.0;
    }
  }
  return bounds;
}

}  // namespace

double score_bound(const BlockSums& sums, const FootprintCells& footprint) {
  const Bounds bounds = bounds_of(sums, footprint);
  if (!bounds.possible) return 0.0;
  double bound = bounds.cap;
  for (const Ends& ends : bounds.map_variance) {
    double max = 0.0;
    for (std::size_t end = 0; end < 2; ++end) {
      const double cross = sums.cross_max - ends.slope_map[end];
      if (cross > 0.0) max = std::max(max, ends.root[end] > 0.0 ? cross / ends.root[end] : bounds.cap);
    }
    bound = std::min(bound, max);
  }
  return bound * (1.0 + kRounding);
}

double cross_needed(const BlockSums& sums, const FootprintCells& footprint, double score) {
  const Bounds bounds = bounds_of(sums, footprint);
  if (!bounds.possible || bounds.cap * (1.0 + kRounding) < score) return std::numeric_limits<double>::infinity();
  double needed = 0.0;
  for (const Ends& ends : bounds.map_variance) {
    double min = std::numeric_limits<double>::infinity();
    for (std::size_t end = 0; end < 2; ++end) {
      min = std::min(min, ends.slope_map[end] + score / (1.0 + kRounding) * ends.root[end]);
    }
    needed = std::max(needed, min);
  }
  return needed;
}

}  // namespace roadfix
