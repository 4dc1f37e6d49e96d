// From the figures of a search to the probability that its best place is the true one, learned from queries with known
// truth (docs/calibration.md). Monotone in every figure, and never surer than the examples: a figure beyond the largest
// one learned from counts as that one, and no probability exceeds `highest`. Above 0.5 it is at most the probability
// that no other place fits as well by chance (SearchFigures::surprise); it is at most 0.5 with less than
// kMinOtherRoadsAcross.
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "core/locate/search_figures.hpp"

namespace roadfix {

/// A probability is that of the true position lying within the ellipse of so many standard deviations about the best
/// mode. It holds 99.97 % of a normal distribution, so that confidences up to 0.999 can be asked for.
inline constexpr double kRegionSigmas = 4.0;

struct CountedFigure {
  std::string_view name;  ///< in calibration files
  double SearchFigures::*value;
};

/// Those that the probability rests on.
inline constexpr std::array<CountedFigure, 4> kCountedFigures{{{"surprise", &SearchFigures::surprise},
                                                               {"lead", &SearchFigures::lead},
                                                               {"gap", &SearchFigures::gap},
                                                               {"ground", &SearchFigures::ground}}};

/// Value of "format" in a calibration file; another set of figures is another format.
inline constexpr std::string_view kCalibrationFormat = "roadfix-calibration-2";

struct Calibration {
  /// One figure in the sum that the logistic function turns into a probability.
  struct Term {
    double weight = 0.0;  ///< >= 0
    double max = 0.0;     ///< larger figures count as this one
  };

  double bias = 0.0;
  std::array<Term, kCountedFigures.size()> terms;
  double highest = 0.0;  ///< probability that the number of examples can vouch for, below 1
  // Factors on the standard deviations that follow from the shape of the peak, so that ellipses hold what they should.
  double position_sigma_scale = 1.0;
  double heading_sigma_scale = 1.0;

  /// That the true position lies within the region of the best mode (kRegionSigmas).
  double probability(const SearchFigures& figures) const;
};

/// The text of a calibration file; its `origin` is for people. Throws InvalidInput "calibration-..." naming the field.
Calibration parse_calibration(std::string_view json);

/// The one that is shipped (schema/calibration.json), the same object every time.
std::shared_ptr<const Calibration> shipped_calibration();

}  // namespace roadfix
