#include "core/grid/cell_moments.hpp"

namespace roadfix {

double CellMoments::mean() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }

double CellMoments::variance() const {
  return count > 0 ? square_sum / static_cast<double>(count) - mean() * mean() : 0.0;
}

double CellMoments::squared_deviations() const {
  return count > 0 ? square_sum - sum * sum / static_cast<double>(count) : 0.0;
}

CellMoments moments_of(const CellArray& cells) {
  CellMoments moments;
  for (const Cell cell : cells.cells()) {
    if (!is_observed(cell)) continue;
    const double p = probability(cell);
    ++moments.count;
    moments.sum += p;
    moments.square_sum += p * p;
  }
  return moments;
}

}  // namespace roadfix
