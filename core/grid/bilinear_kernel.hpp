// Reading many positions between the cells of one array, vectorised for the processor that runs it: what turning a
// feature map to hundreds of headings consists of.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/cell_array.hpp"
#include "core/grid/sampling.hpp"

namespace roadfix {

/// The cells around each position, beside each other: read at once. Thread-safe.
class BilinearSource {
 public:
  explicit BilinearSource(const CellArray& cells);

  /// Each cell of the result is bilinear() at the placement of its middle, rounded to 1/128 of a cell
  /// (SnappedPlacement), to the last bit on every processor.
  CellArray sampled(const Placement& placement, int cols, int rows) const;

 private:
  int cols_;
  int rows_;
  /// The source in a border of unobserved cells: cell (c, r) holds the source's (c - 1, r - 1) in its lowest byte, then
  /// (c, r - 1), (c - 1, r) and (c, r).
  std::vector<std::int32_t> quads_;
};

}  // namespace roadfix
