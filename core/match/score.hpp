// The score that the search ranks poses by: see search.hpp for its meaning.
#pragma once

#include <cstdint>

#include "core/grid/feature_map.hpp"
#include "core/match/correlation.hpp"

namespace roadfix {

/// Variance of the cells below which a footprint, or the map under it, holds too little contrast to be compared: one
/// cell of certain road in ten thousand, or probabilities that differ by 1 %.
inline constexpr double kMinVariance = 1e-4;

/// Whether the map shows as much in the cells observed in both.
bool map_has_contrast(const MatchSums& sums);

/// Pearson's correlation; 0 where the map or the feature map has too little contrast to be compared.
double contrasted_pearson(const MatchSums& sums);

/// What the cells observed in both, at a pose, are measured by.
struct FootprintCells {
  std::int64_t full = 0;  ///< observed in the feature map
  double min = 1.0;       ///< observed in both, below which a pose has no score
};

/// At least one cell and half of those observed have to be observed in both.
FootprintCells footprint_cells(const FeatureMap& features);

/// r * sqrt(n / cells.full); 0 where less than cells.min were observed in both or one of them holds too little road.
double score_of(const MatchSums& sums, const FootprintCells& cells);

}  // namespace roadfix
