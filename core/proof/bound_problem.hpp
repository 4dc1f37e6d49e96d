// What the stages of a proof share: the search, and where its positions lie on the map.
#pragma once

#include "core/grid/feature_rotator.hpp"
#include "core/proof/branch_and_bound.hpp"
#include "core/proof/score_bound.hpp"
#include "core/proof/turned_features.hpp"

namespace roadfix {

struct BoundProblem {
  const BoundedSearch& search;
  const BoundMap& map;
  FeatureRotator rotator;
  int shift_col;  ///< map cell of the first position
  int shift_row;
  int base;  ///< base_of() the feature map

  explicit BoundProblem(const BoundedSearch& asked)
      : search(asked),
        map(*asked.map),
        rotator(*asked.features),
        shift_col(asked.positions.origin.col - map.geometry().origin.col),
        shift_row(asked.positions.origin.row - map.geometry().origin.row),
        base(base_of(*asked.features)) {}

  double bound_of(const BlockSums& sums) const { return score_bound(sums, search.cells); }
  /// The heading with this index among those searched.
  Angle heading(std::size_t index) const { return search.bins.heading(search.headings[index]); }
  /// Whether this cell of the map is an eligible position,
  bool cell_eligible(int map_col, int map_row) const {
    const int col = map_col - shift_col;
    const int row = map_row - shift_row;
    return col >= 0 && row >= 0 && col < search.positions.cols && row < search.positions.rows &&
           search.eligible(col, row);
  }
  /// or any cell of this block of the map is.
  bool block_eligible(int col, int row) const {
    for (int i = 0; i < kBlockCells * kBlockCells; ++i) {
      if (cell_eligible(col * kBlockCells + i % kBlockCells, row * kBlockCells + i / kBlockCells)) return true;
    }
    return false;
  }
};

}  // namespace roadfix
