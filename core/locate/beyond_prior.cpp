#include "core/locate/beyond_prior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace roadfix {
namespace {

// Two footprints farther apart share too few of their streets. Seen of wrong places: up to 0.18.
constexpr double kSharedGroundShare = 0.25;

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

std::optional<PoseRegion> ground_beyond(const PoseRegion& region, const GridPose& pose, const FeatureMap& features) {
  const double reach_m = kSharedGroundShare * features.cell_m * std::max(features.cells.cols(), features.cells.rows());
  if (region.grown(-reach_m, {}).contains(pose.position)) return std::nullopt;
  PoseRegion near = region;
  near.circle = GridCircle{pose.position, reach_m};
  near.box = grown({pose.position, pose.position}, reach_m);
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
            fmt::format("the roads fit better just outside of the searched region, {:.0f} m from the best place in it: "
                        "give a wider prior, or a map that reaches farther",
                        distance_m(best.pose.position, better->pose.position)));
  return decision;
}

}  // namespace roadfix
