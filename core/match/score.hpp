// The score that the search ranks poses by: see search.hpp for its meaning.
#pragma once

#include <cstdint>

#include "core/grid/feature_map.hpp"
#include "core/match/correlation.hpp"

namespace roadfix {

/// Variance of cells below which a footprint, or the map under it, has too little contrast to be compared: that of one
/// cell of certain road in ten thousand, or of probabilities that differ by 1 %.
inline constexpr double kMinVariance = 1e-4;

/// Whether the map has that contrast in the cells observed in both.
bool map_has_contrast(const MatchSums& sums);

/// Pearson's correlation; 0 where the map or the feature map has too little contrast to be compared.
double contrasted_pearson(const MatchSums& sums);

/// What the number of cells observed in both at a pose is compared with.
struct FootprintCells {
  std::int64_t full = 0;  ///< observed in the feature map
  double min = 1.0;       ///< observed in both, below which a pose has no score
};

/// `min` is half of the observed cells, and at least one.
FootprintCells footprint_cells(const FeatureMap& features);

/// r * sqrt(n / cells.full); 0 if fewer than cells.min were observed in both, or either side has too little contrast.
double score_of(const MatchSums& sums, const FootprintCells& cells);

}  // namespace roadfix
