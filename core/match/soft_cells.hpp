// What the search compares instead of probabilities: p^e / (p^e + (1 - p)^e), e times their log odds.
#pragma once

#include <array>

#include "core/grid/cell_array.hpp"

namespace roadfix {

/// Certain cells stay as they are, unobserved ones too; e = 1 changes nothing. Below 1 doubtful roads count for more: a
/// correlation of plain probabilities listens to the few cells that a detector was sure of.
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
