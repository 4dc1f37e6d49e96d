// What of a row of cells was observed.
#pragma once

#include <optional>
#include <span>

#include "core/grid/cell.hpp"
#include "core/units/index_range.hpp"

namespace roadfix {

/// From the first observed cell of the row to the last; nullopt where none is.
std::optional<IndexRange> observed_in(std::span<const Cell> row);

}  // namespace roadfix
