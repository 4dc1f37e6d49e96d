// How much of the ground an agreement rests on.
#pragma once

#include "core/grid/cell_array.hpp"

namespace roadfix {

/// Cells that make map and features correlate, counted by what they contribute: (sum of w)^2 / sum of w^2 over the
/// cells observed in both, w the product of what they lie above their means, 0 unless both do. Of roads that are alike
/// sure their common cells, whatever probability a detector gives to roads. Both of the same size.
double shared_road_cells(const CellArray& map, const CellArray& features);

}  // namespace roadfix
