#include "core/locate/beyond_prior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace roadfix {
namespace {

// Beyond the border, in sides of the footprint: from there a place inside shares few of the streets that are seen.
constexpr double kBeyond = 0.5;
// Around the best place; farther away in a large region other places in it speak for themselves.
constexpr double kAroundM = 1000.0;

/// A region is convex: it holds what its corners span.
bool holds(const PoseRegion& region, const GridBox& box) {
  return region.contains(box.min) && region.contains(box.max) &&
         region.contains(GridPoint{box.min.east_m, box.max.north_m}) &&
         region.contains(GridPoint{box.max.east_m, box.min.north_m});
}

bool is_another_place(const SearchMode& a, const SearchMode& b) {
  return distance_m(a.pose.position, b.pose.position) >
         kRegionSigmas * std::sqrt(a.covariance[0][0] + a.covariance[1][1]);
}

void take_back(Decision& decision, const char* reason, std::string explanation) {
  decision.status = FixStatus::kNoFix;
  decision.reason = reason;
  decision.explanation = std::move(explanation);
}

}  // namespace

std::optional<PoseRegion> ground_beyond(const PoseRegion& region, const GridBox& map_extent, const GridPose& pose,
                                        const FeatureMap& features) {
  const double side_m = features.cell_m * std::max(features.cells.cols(), features.cells.rows());
  PoseRegion near = region.grown(kBeyond * side_m, {});
  const GridBox around = grown({pose.position, pose.position}, kAroundM);
  near.box = intersection(intersection(near.box, around), map_extent);
  if (near.box.empty() || holds(region, near.box)) return std::nullopt;
  return near;
}

Decision confirmed(Decision decision, const SearchResult& found, const PoseRegion& region, const SearchResult& near) {
  if (!near.complete()) {
    take_back(decision, kTimeLimitReason,
              "the time limit ended the search before the ground just outside of the region was compared: give more "
              "time, or a larger region");
    return decision;
  }
  const SearchMode& best = found.modes.front();
  const auto better = std::ranges::find_if(near.modes, [&](const SearchMode& mode) {
    return mode.score > best.score && !region.contains(mode.pose.position) && is_another_place(best, mode);
  });
  if (better == near.modes.end()) return decision;
  const ScoreBackground& chance = found.background;
  const double share = 1.0 / (1.0 + std::exp(chance.log_likelihood(better->score) - chance.log_likelihood(best.score)));
  decision.probability *= share;
  for (double& weight : decision.weights) weight *= share;
  take_back(decision, kBetterOutsideReason,
            fmt::format("the roads fit better just outside of the prior, {:.0f} m from the best place in it: check the "
                        "prior, or give a wider one",
                        distance_m(best.pose.position, better->pose.position)));
  return decision;
}

}  // namespace roadfix
