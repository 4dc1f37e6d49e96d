#include "core/locate/footprint_refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/grid/cell_moments.hpp"
#include "core/grid/observed_range.hpp"
#include "core/match/score.hpp"
#include "core/search/shared_road.hpp"

namespace roadfix {
namespace {

// Of a square as large as the ground that was seen. Eight frames of a flight of which every second was left out stay
// within, and frames of cameras that lean far.
constexpr double kMostSidesFar = 6.0;
constexpr double kNeverFarM = 1500.0;

double observed_m2(const FeatureMap& features) {
  return features.cell_m * features.cell_m * static_cast<double>(features.cells.observed_count());
}

}  // namespace

GroundReach ground_reach(const FeatureMap& features) {
  const CellArray& cells = features.cells;
  double farthest = 0.0;
  for (int row = 0; row < cells.rows(); ++row) {
    const auto seen = observed_in(cells.row(row));
    if (!seen) continue;
    const double left = features.nadir.col - seen->first;
    const double right = seen->end - features.nadir.col;
    const double along = std::max(features.nadir.row - row, row + 1 - features.nadir.row);
    farthest = std::max(farthest, std::hypot(std::max(left, right), along));
  }
  return {features.cell_m * farthest, std::max(kNeverFarM, kMostSidesFar * std::sqrt(observed_m2(features)))};
}

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
  if (const GroundReach reach = ground_reach(features); reach.too_far()) {
    return FootprintRefusal{
        "footprint-too-small",
        fmt::format("the feature map shows {:.0f} m2 of ground, up to {:.0f} m from the point below the UAV, and for "
                    "so little at most {:.0f} m are searched: give a map of the ground near the UAV only",
                    ground_m2, reach.farthest_m, reach.allowed_m)};
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
