// What the search compares instead of probabilities: p^e / (p^e + (1 - p)^e), e times their log odds.
#pragma once

#include <array>

#include "core/grid/cell_array.hpp"

namespace roadfix {

/// Certain and unobserved cells stay as they are; e = 1 changes nothing. With e below 1 doubtful roads count for more:
/// a correlation of plain probabilities depends mostly on the few cells that a detector was sure of.
class SoftCells {
 public:
  /// `exponent` in (0, 1].
  explicit SoftCells(double exponent);

  Cell of(Cell cell) const { return table_[cell]; }
  void apply(CellArray& cells) const;

 private:
  std::array<Cell, 256> table_{};
};

}  // namespace roadfix
