#include "core/match/coverage.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace roadfix {
namespace {

/// Bits of a cell: whether it is observed from any position, and whether it is missed from any.
constexpr Cell kCovered = 1;
constexpr Cell kMissed = 2;

/// out[i] = everything that in[i - side + 1] ... in[i] holds; both begin side - 1 places before `out`.
void gather(const Cell* in, std::ptrdiff_t apart, int side, std::size_t count, Cell* out) {
  std::copy_n(in, count, out);
  for (int k = 1; k < side; ++k) {
    const Cell* before = in - k * apart;
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<Cell>(out[i] | before[i]);
  }
}

}  // namespace

Coverage Coverage::of(const FeatureMap& north_up, int side) {
  const CellArray& cells = north_up.cells;
  const int more = side - 1;
  const int cols = cells.cols() + more;
  const int rows = cells.rows() + more;
  CellArray seen(cols + more, rows + more, kMissed);
  for (int row = 0; row < cells.rows(); ++row) {
    const auto from = cells.row(row);
    std::ranges::transform(from, seen.row(row + more).begin() + more,
                           [](Cell cell) { return is_observed(cell) ? kCovered : kMissed; });
  }
  CellArray wide(cols, rows + more);
  for (int row = 0; row < wide.rows(); ++row) {
    gather(&seen.row(row)[static_cast<std::size_t>(more)], 1, side, wide.row(row).size(), wide.row(row).data());
  }
  CellArray always(cols, rows);
  CellArray sometimes(cols, rows);
  std::vector<Cell> both(static_cast<std::size_t>(cols));
  for (int row = 0; row < rows; ++row) {
    gather(wide.row(row + more).data(), cols, side, both.size(), both.data());
    std::ranges::transform(both, always.row(row).begin(), [](Cell b) { return b == kCovered ? Cell{0} : kUnobserved; });
    std::ranges::transform(both, sometimes.row(row).begin(),
                           [](Cell b) { return b == (kCovered | kMissed) ? Cell{0} : kUnobserved; });
  }
  return {Footprint({std::move(always), north_up.cell_m, north_up.nadir}),
          Footprint({std::move(sometimes), north_up.cell_m, north_up.nadir})};
}

}  // namespace roadfix
