// Is the best place the true one? From the scores of a search to a status and a probability.
//
// The calibration turns the figures of the search into the probability of the best place. A place around the region
// that fits as well takes its share of it, since the vehicle may be there. The weights of the other modes are in
// proportion to their posteriors (by the tempered ScoreBackground::log_likelihood()), but sum to at most what the
// probability of the best one leaves.
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
  /// Of the first modes of the search, best first: of all of them, or for an ambiguous answer of those with at least
  /// kModeShare of the best one's posterior. The first weight is the probability; they sum to at most 1.
  std::vector<double> weights;
};

inline constexpr double kModeShare = 0.01;

/// `found`: of a search of `region`. `bare`: the feature map shows less than a road across (footprint_refusal.hpp),
/// which the explanation says where chance explains the best place.
Decision decide(const SearchResult& found, const PoseRegion& region, const Calibration& calibration, double confidence,
                bool bare);

}  // namespace roadfix
