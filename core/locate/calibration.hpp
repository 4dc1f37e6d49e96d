// From what a search says about its best place to the probability that it is the true one, learned from queries with
// known truth (docs/calibration.md). Monotone in every figure, and never surer than the examples it was learned from:
// beyond the largest value learned from a figure counts as that value, and no probability exceeds `highest`. Above 0.5
// it is no surer than the search itself that no other place fits as well by chance, whatever the examples say; at most
// 0.5 where the place rests on less than kMinOtherRoadsAcross.
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "core/locate/search_figures.hpp"

namespace roadfix {

/// The region that a probability speaks of: the ellipse of so many standard deviations about the best mode. It holds
/// 99.97 % of a normal distribution, so that confidences up to 0.999 can be asked for.
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
  double highest = 0.0;  ///< what the number of examples can vouch for, below 1
  // Factors on the standard deviations that the shape of the peak gives, so that ellipses hold what they should.
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
