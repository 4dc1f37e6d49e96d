// The score that the search ranks poses by: see search.hpp for its meaning.
#pragma once

#include "core/match/correlation.hpp"

namespace roadfix {

/// Variance of the cells below which a footprint, or the map under it, holds too little contrast to be compared: one
/// cell of certain road in ten thousand, or probabilities that differ by 1 %.
inline constexpr double kMinVariance = 1e-4;

/// r * sqrt(n / full_cells); 0 where less than `min_cells` were observed in both or one of them holds too little
/// road.
double score_of(const MatchSums& sums, std::int64_t full_cells, double min_cells);

}  // namespace roadfix
