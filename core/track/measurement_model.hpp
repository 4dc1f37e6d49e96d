// What a match says about a pose: the measurement model of the filter.
#pragma once

#include <cstdint>

#include "core/locate/search_figures.hpp"
#include "core/match/correlation.hpp"

namespace roadfix {

enum class LikelihoodKind {
  /// How much likelier Pearson's correlation is at the true pose than by chance, both taken as normal, with the spread
  /// of as many independent samples of the ground.
  kCorrelation,
  /// Equation (7) as it is.
  kEquation7,
};

/// Chosen by flights (docs/tracks-history.md): they set how soon the filter commits, not which place it prefers.
struct MeasurementModel {
  LikelihoodKind kind = LikelihoodKind::kCorrelation;
  double expected_correlation = 0.25;  ///< mean correlation at the true pose, 0 to 1
  /// n samples of kSampleM2 count for n / (1 + n / most_samples), so for no more than this however large a frame is:
  /// what its detector, its attitude or the map's registration err by goes together over all of it.
  double most_samples = 150.0;
  double temper = 0.5;         ///< exponent of each likelihood, below 1 since consecutive frames see the same ground
  double useless_share = 0.1;  ///< how many of all frames say nothing even at the true pose, 0 to 1

  /// Natural logarithm of how much likelier the measurement is at this pose than by chance; for equation (7) the
  /// logarithm of P itself, -infinity where P is 0.
  ///
  /// `frame_cells` is how many cells the feature map observes. Those that the map does not observe are taken to agree
  /// as by chance: if they were left out, a pose mostly off the map, where little can disagree, would beat the true
  /// one. Equation (7) counts only the cells observed in both, however few.
  double log_likelihood(const MatchSums& sums, std::int64_t frame_cells, double cell_m) const;
  /// Whether a measurement whose mean likelihood under the belief is this supports the belief.
  bool supports(double mean_likelihood) const;
};

}  // namespace roadfix
