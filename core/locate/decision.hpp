// Is the best place the true one? From the scores of a search to a status and a probability.
//
// The calibration makes the probability of the best place from the figures of the search, and a place around the region
// that fits as well takes its share of it: the vehicle may be there. The weights of the other places that fit are in
// proportion to their posteriors (by the tempered ScoreBackground::log_likelihood()), but sum to no more than the
// probability leaves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/locate/calibration.hpp"
#include "core/locate/fix.hpp"
#include "core/search/search.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

struct Decision {
  FixStatus status = FixStatus::kNoFix;
  std::string reason;
  std::string explanation;
  double probability = 0.0;
  std::optional<SearchFigures> figures;  ///< of the best mode, where there is one
  /// Of the modes of the search that count, best first: all of a fix or a refusal, of an ambiguous answer those with at
  /// least kModeShare of the best one's posterior. The first is the probability, and all sum to at most 1.
  std::vector<double> weights;
};

inline constexpr double kModeShare = 0.01;

/// `found` within `region`. `bare`: the feature map shows less road than a single one across it
/// (footprint_refusal.hpp), which is said where chance explains the best place.
Decision decide(const SearchResult& found, const PoseRegion& region, const Calibration& calibration, double confidence,
                bool bare);

}  // namespace roadfix
