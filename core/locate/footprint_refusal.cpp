#include "core/locate/footprint_refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/grid/cell_moments.hpp"
#include "core/locate/search_figures.hpp"
#include "core/match/score.hpp"

namespace roadfix {
namespace {

// On less, one place always fits far better than the others, and what tells chance from more than chance no longer
// holds.
constexpr double kMinGroundM2 = 16.0 * kSampleM2;

double observed_m2(const FeatureMap& features) {
  return features.cell_m * features.cell_m * static_cast<double>(features.cells.observed_count());
}

}  // namespace

std::optional<FootprintRefusal> refusal_of(const FeatureMap& features) {
  const double ground_m2 = observed_m2(features);
  if (ground_m2 == 0.0) {
    return FootprintRefusal{
        "footprint-unobserved",
        "no cell of the feature map was observed, or only a corner far from the UAV: the frame shows no ground to "
        "match"};
  }
  if (ground_m2 < kMinGroundM2) {
    return FootprintRefusal{
        "footprint-too-small",
        fmt::format("the frame shows {:.0f} m2 of ground, and at least {:.0f} m2 are needed to tell places apart: "
                    "check its scale (metres per pixel or cell), fly higher, or combine several frames",
                    ground_m2, kMinGroundM2)};
  }
  if (moments_of(features.cells).variance() < kMinVariance) {
    return FootprintRefusal{"too-few-roads",
                            "the feature map shows hardly any road, or road everywhere: there is nothing to match"};
  }
  return std::nullopt;
}

bool shows_less_than_a_road_across(const FeatureMap& features) {
  const auto roads = static_cast<double>(std::ranges::count_if(features.cells.cells(), is_road));
  const double road_m2 = features.cell_m * features.cell_m * roads;
  return road_m2 < kRoadWidthM * std::sqrt(observed_m2(features));
}

}  // namespace roadfix
