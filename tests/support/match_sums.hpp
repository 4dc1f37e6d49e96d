// The sums of equation (5), cell by cell: what the program's own are compared with.
#pragma once

#include "core/match/correlation.hpp"

namespace roadfix::testing {

/// A cell that is `m` in the map and `l` in the feature map.
inline void add_cell(MatchSums& sums, double m, double l) {
  ++sums.n;
  sums.m += m;
  sums.l += l;
  sums.mm += m * m;
  sums.ll += l * l;
  sums.ml += m * l;
}

}  // namespace roadfix::testing
