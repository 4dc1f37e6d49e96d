// Means of 2 x 2 cells, vectorised for the processor that runs it: what overviews are made of.
#pragma once

#include <span>

#include "core/grid/cell.hpp"

namespace roadfix {

/// Mean of the observed cells of each two columns of two rows of equal length, rounded to the nearest, halves up;
/// unobserved where none is. `means` has half as many, rounded up: the last of an odd number of columns is by itself.
void halve_rows(std::span<const Cell> upper, std::span<const Cell> lower, std::span<Cell> means);

}  // namespace roadfix
