// From what is known of a block of poses to the best score that any of them can have.
//
// With n cells observed in both, sums S over them, and score.hpp's r sqrt(n / full),
//
//     r = (S_ml - S_l S_m / n) / sqrt(V_m V_l),   V_m = S_mm - S_m^2 / n,   V_l = S_ll - S_l^2 / n.
//
// Above: sum over l > base of (l - base) m is C = BlockSums::cross_max at most, and S_l / n is no less than some mean,
// so that S_ml - S_l S_m / n <= C - (mean - base) S_m. Below: V_l is at least the least S_ll less the most S_l^2 / n.
// V_m has two bounds of the form a S_m + b - S_m^2 / n: a = 0 with b the least S_mm; and, which is more where cells are
// nearly 0 or span, a = span with -b the most that sum m (span - m) = span S_m - S_mm can be.
//
// What is left unknown is S_m. A score s is possible only if C >= (mean - base) S_m + s sqrt(V_l V_m full / n),
// which is concave in S_m: least at an end of its interval.
#pragma once

#include "core/match/score.hpp"

namespace roadfix {

struct Interval {
  double min = 0.0;
  double max = 0.0;
};

/// Sums over the cells observed in both, of which only bounds are known; l and m in the same unit as `span`.
struct BlockSums {
  double cross_max = 0.0;       ///< of (l - base) m over the cells with l above the base
  Interval map;                 ///< of m >= 0
  double map_square_min = 0.0;  ///< of m^2
  double map_mixed_max = 0.0;   ///< of m (span - m), of any one pose
  Interval feature;             ///< of l
  double feature_square_min = 0.0;
  Interval cells;
  double base = 0.0;
  double span = 1.0;  ///< most that m can be
};

/// At least the score (score.hpp) of any pose with such sums, in [0, about 1].
double score_bound(const BlockSums& sums, const FootprintCells& footprint);

/// The value of cross_max below which score_bound() is less than `score`; may be infinite.
double cross_needed(const BlockSums& sums, const FootprintCells& footprint, double score);

}  // namespace roadfix
