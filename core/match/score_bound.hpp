// From what is known of a block of poses to the best score that any of them can have.
#pragma once

namespace roadfix {

struct Interval {
  double min = 0.0;
  double max = 0.0;
};

/// Sums over the cells observed in both, of which only bounds are known; l and m in the same unit as `span`.
struct BlockSums {
  double cross_max = 0.0;  ///< of (l - base) m over the cells with l above the base
  Interval map;            ///< of m >= 0
  Interval map_square;     ///< of m^2; max only matters together with map.max
  Interval feature;        ///< of l
  double feature_square_min = 0.0;
  Interval cells;
  double base = 0.0;
  double span = 1.0;  ///< most that m can be
};

/// At least the score (score.hpp) of any pose with such sums, in [0, about 1].
double score_bound(const BlockSums& sums, double full_cells, double min_cells);

/// The value of cross_max below which score_bound() is less than `score`; may be infinite.
double cross_needed(const BlockSums& sums, double full_cells, double min_cells, double score);

}  // namespace roadfix
