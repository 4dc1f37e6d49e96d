// The feature map's part of an upper bound on scores (bound_map.hpp): the pieces of road that it consists of at one
// heading, and the blocks of the map that its footprint covers.
#pragma once

#include <vector>

#include "core/grid/feature_map.hpp"
#include "core/proof/block_cover.hpp"
#include "core/proof/bound_map.hpp"
#include "core/proof/bound_terms.hpp"
#include "core/proof/road_lines.hpp"
#include "core/proof/row_run.hpp"

namespace roadfix {

/// The value above which a feature map's cells count in the bound: the median of the observed cells.
int base_of(const FeatureMap& features);
/// Cells above the base, less the base; unobserved elsewhere.
FeatureMap above_base(const FeatureMap& features, int base);

/// One heading. Values are cells as stored (0..254), map values less the map's base.
struct TurnedFeatures {
  double cells = 0.0, sum = 0.0, square = 0.0;  ///< over the observed cells
  BoundTerms cross;                             ///< bounds the sum of (l - base) m from above
  BoundTerms sum_min, sum_max, square_min;      ///< bound sums of l and l^2 over cells where the map is observed
  BlockCover cover;
  std::vector<RowRun> runs;  ///< the observed cells, relative to the nadir's

  /// `turned` = rotated(features, heading).
  TurnedFeatures(const FeatureMap& turned, Angle heading, int base, const LineHints& hints, const BoundMap& map);
};

}  // namespace roadfix
