// What a feature map alone says against a search for it: too little ground, also for how far off it lies, or too little
// road on it.
#pragma once

#include <optional>
#include <string>

#include "core/grid/feature_map.hpp"
#include "core/locate/search_figures.hpp"

namespace roadfix {

/// On less, one place always fits far better than the others, and what tells chance from more than chance no longer
/// holds.
inline constexpr double kMinGroundM2 = 16.0 * kSampleM2;

/// How far from the point below the UAV the farthest observed ground lies, and how far it may: memory and time of a
/// search grow with its square or more.
struct GroundReach {
  double farthest_m = 0.0;
  double allowed_m = 0.0;
  bool too_far() const { return farthest_m > allowed_m; }
};
GroundReach ground_reach(const FeatureMap& features);

struct FootprintRefusal {
  const char* reason;       ///< of a Fix
  std::string explanation;  ///< of a Fix
};

/// nullopt where there is something to search for, as far as the feature map alone tells.
std::optional<FootprintRefusal> refusal_of(const FeatureMap& features);

/// Less than a road of kRoadWidthM from one side of the observed ground to the other, if that were a square.
bool shows_less_than_a_road_across(const FeatureMap& features);

}  // namespace roadfix
