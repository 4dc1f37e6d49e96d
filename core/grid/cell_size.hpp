// Sizes of cells that come from two places.
#pragma once

#include <cmath>

namespace roadfix {

/// Up to what a number loses in a text.
inline bool is_same_cell_size(double one_m, double other_m) { return std::abs(one_m / other_m - 1.0) <= 1e-6; }

}  // namespace roadfix
