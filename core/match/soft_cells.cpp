#include "core/match/soft_cells.hpp"

#include <cassert>
#include <cmath>

namespace roadfix {

SoftCells::SoftCells(double exponent) {
  assert(exponent > 0.0 && exponent <= 1.0);
  table_[kUnobserved] = kUnobserved;
  for (int k = kNoRoad; k <= kRoad; ++k) {
    const double p = probability(static_cast<Cell>(k));
    const double road = std::pow(p, exponent);
    table_[static_cast<std::size_t>(k)] = cell_from_probability(road / (road + std::pow(1.0 - p, exponent)));
  }
}

void SoftCells::apply(CellArray& cells) const {
  for (Cell& cell : cells.cells()) cell = of(cell);
}

}  // namespace roadfix
