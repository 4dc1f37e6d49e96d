// What a match says about a pose: the measurement model of the filter.
#pragma once

#include <cstdint>

#include "core/match/correlation.hpp"

namespace roadfix {

enum class LikelihoodKind {
  /// How much likelier the correlation (Pearson's, over the means of m and l apart) is at the true pose than by chance,
  /// both taken as normal with the spread that independent samples of the ground leave.
  kCorrelation,
  /// Each cell by its own: P(l = 1) = m a + (1 - m) b with detection rates a and b, against a
  /// chance of l as often as it is on average. Between no road and road, log P is taken as linear in m, so that three
  /// sums are enough.
  kDetectionRates,
  /// Equation (7) as it is.
  kEquation7,
};

/// Assumed values, not learned from data: they set how soon the filter commits, not which place it prefers.
struct MeasurementModel {
  LikelihoodKind kind = LikelihoodKind::kCorrelation;
  double expected_correlation = 0.25;  ///< at the true pose
  double detection_rate = 0.6;         ///< a
  double false_rate = 0.1;             ///< b
  /// Ground that counts as one sample, since errors of near cells go together: four times the kSampleM2 of a search,
  /// for a sample that is counted twice makes a track sure too early.
  double independent_m2 = 900.0;
  double temper = 0.5;         ///< exponent, since consecutive frames see the same ground
  double useless_share = 0.1;  ///< of frames that say nothing even at the true pose

  /// Log of the likelihood ratio to chance (of P for equation 7; -inf where it is 0).
  ///
  /// `frame_cells` is how many cells the feature map observes. Those that the map does not are taken to agree as by
  /// chance: by saying nothing of them, a pose mostly outside the map would beat all that have something against them.
  /// Equation (7) is as it stands and speaks of the cells observed in both, however few.
  double log_likelihood(const MatchSums& sums, std::int64_t frame_cells, double cell_m) const;
  /// Whether a measurement with this mean likelihood supports the belief.
  bool supports(double mean_likelihood) const;
};

}  // namespace roadfix
