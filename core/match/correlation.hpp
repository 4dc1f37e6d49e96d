// Equations (5) to (7): how well a feature map l fits the global map m at a pose, over the cells observed in both.
#pragma once

#include <cstdint>
#include <optional>

namespace roadfix {

/// The sums from which equation (5) follows; m and l in [0, 1], over the N cells observed in both.
struct MatchSums {
  std::int64_t n = 0;
  double m = 0.0;
  double l = 0.0;
  double mm = 0.0;
  double ll = 0.0;
  double ml = 0.0;

  /// A cell that is `m_cell` in the map and `l_cell` in the feature map.
  void add(double m_cell, double l_cell) {
    ++n;
    m += m_cell;
    l += l_cell;
    mm += m_cell * m_cell;
    ll += l_cell * l_cell;
    ml += m_cell * l_cell;
  }
};

/// Equation (5) with the common mean (6). nullopt where it is undefined: no cell in common, or m and l constant at
/// the common mean.
std::optional<double> rho(const MatchSums& sums);

/// Correlation about the means of m and of l apart (Pearson): what the search ranks by, since unlike (5) it does not
/// change with the detector's overall rate. nullopt where m or l is constant.
std::optional<double> pearson(const MatchSums& sums);

/// Equation (7).
double likelihood(double rho);

struct MatchScore {
  std::optional<double> rho;
  std::int64_t observed_cells = 0;
};

}  // namespace roadfix
