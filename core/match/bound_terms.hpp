// The feature map's side of an upper bound on scores (bound_map.hpp): at one heading, the pieces of road that it
// consists of, and which blocks of the map its footprint covers.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/grid/feature_map.hpp"
#include "core/match/block_cover.hpp"
#include "core/match/bound_map.hpp"
#include "core/match/row_run.hpp"

namespace roadfix {

/// A sum over blocks of planes: of the weight of each group of terms times their plane values. Terms of a group lie
/// side by side.
struct BoundTerms {
  struct Term {
    std::int16_t col = 0;  ///< block relative to the nadir's
    std::int16_t row = 0;
    std::int16_t plane = 0;
  };
  struct Group {
    std::uint32_t weight = 0;
    std::uint32_t end = 0;  ///< of its terms, after those of the groups before
  };
  std::vector<Term> terms;
  std::vector<Group> groups;
  double unit = 1.0;  ///< of the weights: sums stay below 2^32
};

enum class Rounding { kUp, kDown };

/// Weights (>= 0) rounded to a few, so that many terms share one: sums are at least (kUp) or at most (kDown) those of
/// the exact weights.
BoundTerms quantized(std::vector<std::pair<double, BoundTerms::Term>> weighted, Rounding rounding);

/// Straight pieces of the feature map, in its body frame; found once, then turned.
struct LineHint {
  double col = 0.0;  ///< centre, cells from the nadir
  double row = 0.0;
  double angle = 0.0;  ///< from columns towards rows, radians
};
struct LineHints {
  int level = 0;  ///< what a piece counts above the base, 1..254
  std::vector<LineHint> lines;
};

/// Value of a feature map that the bound counts from: half of the observed cells lie at or below.
int base_of(const FeatureMap& features);
/// What lies above the base, less the base; unobserved elsewhere.
FeatureMap above_base(const FeatureMap& features, int base);
LineHints find_lines(const FeatureMap& features, int base);

/// One heading. Values are cells as stored (0..254), map values less the map's base.
struct TurnedFeatures {
  double cells = 0.0, sum = 0.0, square = 0.0;  ///< over the observed cells
  BoundTerms cross;                             ///< sum of (l - base) m', at most
  BoundTerms sum_min, sum_max, square_min;      ///< over cells where the map is observed
  BlockCover cover;
  std::vector<RowRun> runs;  ///< the observed cells, relative to the nadir's

  /// `turned` = rotated(features, heading).
  TurnedFeatures(const FeatureMap& turned, Angle heading, int base, const LineHints& hints, const BoundMap& map);
};

}  // namespace roadfix
