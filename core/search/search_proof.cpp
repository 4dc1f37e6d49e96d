#include "core/search/search_proof.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "core/proof/branch_and_bound.hpp"

namespace roadfix {
namespace {

/// All but the feature map and the map.
BoundedSearch bounded_search(const SearchLevels& levels, const Level& level, const SearchOptions& options,
                             const std::vector<LatticePose>& candidates) {
  const PoseRegion wide = SearchLevels::widened(levels.region(), level);
  BoundedSearch bounded;
  bounded.bins = level.bins;
  bounded.headings = bins_within(level.bins, wide);
  bounded.positions = GridGeometry::covering(wide.box, level.cell_m());
  bounded.eligible = cells_within(bounded.positions, wide);
  bounded.threads = options.threads;
  for (const LatticePose& pose : candidates) {
    if (wide.contains(level.pose_of(pose))) bounded.known = std::max(bounded.known, pose.score);
  }
  return bounded;
}

/// The map of the level, nullptr where time runs out.
std::shared_ptr<const BoundMap> map_before(const Deadline& deadline, const GridGeometry& window, const Level& level,
                                           int halvings, const SearchOptions& options) {
  while (!deadline.over()) {
    try {
      // The halvings are part of the key since searches differ in the finest cells that these are means of.
      return get_or_build<BoundMap>(options.cache, window, {halvings}, deadline,
                                    [&] { return BoundMap(level.read(window), deadline); });
    } catch (const BoundMap::TimeIsOver&) {
      // Perhaps that of another search, which was building it for both.
    }
  }
  return nullptr;
}

}  // namespace

SearchProof prove(const SearchLevels& levels, const SearchOptions& options, std::vector<LatticePose>& candidates) {
  const Level& level = levels.at(levels.proof_level());
  BoundedSearch bounded = bounded_search(levels, level, options, candidates);
  SearchProof proof{
      level.cell_m(), static_cast<int>(bounded.headings.size()), level.scales.count(), 0.0, 1.0, false, 0.0};
  // Candidates that were not followed to this level in time have the scores of coarser cells.
  if (options.deadline.over()) return proof;
  proof.best_score = bounded.known;
  // Following the best pose to the finest cells needs the rest of the time.
  const Deadline deadline = options.deadline.after(0.5).within(options.proof_time);
  const int largest = level.scales.reach();
  const GridGeometry window = bounded.positions.padded(level.reach(largest) + BoundMap::kBorder);
  const auto map = map_before(deadline, window, level, levels.halvings(levels.proof_level()), options);
  if (!map) return proof;
  bounded.map = map.get();
  proof.bound = 0.0;
  proof.complete = true;
  std::optional<LatticePose> better;
  for (int scale = -largest; scale <= largest; ++scale) {
    const LevelFeatures features = level.at_scale(scale);
    bounded.features = &features.map;
    bounded.cells = features.cells;
    const BoundedResult found = search_with_bound(bounded, deadline);
    if (found.better) {
      better = found.better;
      better->scale_step = scale;
      bounded.known = better->score;
    }
    proof.bound = std::max(proof.bound, found.bound);
    proof.complete = proof.complete && found.complete;
    proof.excluded_share += found.excluded_share;
  }
  if (better) candidates.push_back(*better);
  proof.best_score = bounded.known;
  proof.excluded_share /= proof.scales;
  return proof;
}

}  // namespace roadfix
