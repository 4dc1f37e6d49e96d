// What of a row of cells was observed.
#pragma once

#include <optional>
#include <span>

#include "core/grid/cell.hpp"

namespace roadfix {

/// Columns [first, end).
struct ColumnRange {
  int first = 0;
  int end = 0;
};

/// From the first observed cell of the row to the last; nullopt where none is.
std::optional<ColumnRange> observed_in(std::span<const Cell> row);

}  // namespace roadfix
