// Is the best place the true one? From the scores of a search to a status and a probability.
//
// Two doubts are told apart.
// (1) Chance: among so many places some fit well although the UAV is at none of them. The scores of the distinct places
//     beside the best one tell how fast such maxima thin out (an exponential tail of their Fisher z above the lowest of
//     them); from that follows how many at least as good as the best one chance would give.
// (2) Several places that fit: the posterior over the modes from their tempered log-likelihood (ScoreBackground).
//
// Assumed, not yet learned from data: the exponential tail, a factor kChanceSafety on the expected number, the temper
// of the likelihood. All lean to the side of no fix.
#pragma once

#include <string>
#include <vector>

#include "core/locate/fix.hpp"
#include "core/match/search.hpp"

namespace roadfix {

struct Decision {
  FixStatus status = FixStatus::kNoFix;
  std::string reason;
  std::string explanation;
  double probability = 0.0;
  std::vector<double> weights;  ///< per mode of the search, against each other and against chance
};

/// How many places of the region would reach the score of the best mode by chance; infinity where too few rivals tell.
double expected_by_chance(double best_score, const ScoreBackground& background);

Decision decide(const SearchResult& found, double confidence);

}  // namespace roadfix
