// Mean and spread of the probabilities in an array of cells.
#pragma once

#include <cstdint>

#include "core/grid/cell_array.hpp"

namespace roadfix {

/// Sums over the observed cells, their probabilities in [0, 1].
struct CellMoments {
  std::int64_t count = 0;
  double sum = 0.0;
  double square_sum = 0.0;

  /// All 0 where no cell is observed.
  double mean() const;
  double variance() const;
  double squared_deviations() const;  ///< from the mean, summed
};

CellMoments moments_of(const CellArray& cells);

}  // namespace roadfix
