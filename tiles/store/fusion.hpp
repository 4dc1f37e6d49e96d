// One map out of several sources: the logarithmic opinion pool (Genest, Zidek 1986), the mean of the log-odds of the
// sources that observed a cell. It depends on no order, repeating a source changes nothing, and two sources that
// contradict each other with equal certainty give 1/2.
#pragma once

#include <span>

#include "core/grid/cell_array.hpp"

namespace roadfix {

/// All tiles must have one size. A cell that one source observed is copied, a cell that none observed is unobserved.
/// Certainty is bounded (core/grid/log_odds.hpp).
CellArray fused(std::span<const CellArray> sources);

}  // namespace roadfix
