// Invented cells for tests: noise, and smooth fields with structure at the scale of a few cells.
#pragma once

#include <random>

#include "core/grid/cell_array.hpp"

namespace roadfix::testing {

/// Uniform values; a share of `unobserved` in [0, 1] of the cells is unobserved.
CellArray random_cells(std::mt19937_64& random, int cols, int rows, double unobserved);

/// Every cell observed, neighbours alike: noise averaged over 5 x 5 cells and stretched to the full range.
CellArray smooth_cells(std::mt19937_64& random, int cols, int rows);

}  // namespace roadfix::testing
