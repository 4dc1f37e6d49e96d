// A feature map taken apart into straight pieces of road (line_stencil.hpp).
#pragma once

#include <vector>

#include "core/grid/feature_map.hpp"
#include "core/proof/line_stencil.hpp"

namespace roadfix {

/// What is left of a feature map above a base, unobserved cells counting as 0, while pieces are taken from it.
class RoadRemainder {
 public:
  RoadRemainder(const CellArray& cells, int base);

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  /// 0 outside.
  int at(int col, int row) const { return contains(col, row) ? values_[index(col, row)] : 0; }
  int highest() const;

  /// How much of a piece of that level around the cell is there: at most `level` of each of its cells.
  int share(const std::vector<CellOffset>& piece, CellOffset at, int level) const;
  void take(const std::vector<CellOffset>& piece, CellOffset at, int level);

 private:
  bool contains(int col, int row) const { return col >= 0 && row >= 0 && col < cols_ && row < rows_; }
  std::size_t index(int col, int row) const { return static_cast<std::size_t>(row * cols_ + col); }

  int cols_;
  int rows_;
  std::vector<int> values_;
};

/// Straight pieces of the feature map, in its body frame; found once, then turned.
struct LineHint {
  double col = 0.0;  ///< centre, cells from the nadir
  double row = 0.0;
  double angle = 0.0;  ///< from columns towards rows, radians
};
struct LineHints {
  int level = 0;  ///< what a piece counts above the base, 1..254
  std::vector<LineHint> lines;
};

LineHints find_lines(const FeatureMap& features, int base);

}  // namespace roadfix
