// Is there a better pose in a region than the best one known? Upper bounds for all blocks of positions at every
// heading, then a closer look at the blocks that could hold a better one, until none is left: a proof, or the better
// pose.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/grid/feature_map.hpp"
#include "core/match/deadline.hpp"
#include "core/match/heading_bins.hpp"
#include "core/match/lattice_pose.hpp"
#include "core/match/score.hpp"
#include "core/proof/bound_map.hpp"

namespace roadfix {

struct BoundedSearch {
  /// Covers `positions` with the footprint's reach and BoundMap::kBorder on every side.
  const BoundMap* map = nullptr;
  const FeatureMap* features = nullptr;  ///< in cells of the map, not constant
  HeadingBins bins{2};
  std::vector<int> headings;                       ///< bins to search, ascending; at least one
  GridGeometry positions;                          ///< cells of which the centres are searched; not empty
  std::function<bool(int col, int row)> eligible;  ///< whether a cell of `positions` is in the region; thread-safe
  FootprintCells cells;                            ///< of `features`
  double known = 0.0;                              ///< score of the best pose known so far
  int threads = 1;
};

struct BoundedResult {
  /// The best pose, if it scores more than `known`; if not `complete`, the best one found. Of equal ones the first by
  /// is_better().
  std::optional<LatticePose> better;
  /// No pose of the region scores more than this; if `complete`, it is the best score known or found.
  double bound = 0.0;
  bool complete = true;         ///< false if time ran out
  double excluded_share = 1.0;  ///< of all poses, at least; 1 if `complete`
};

/// At the deadline it stops and returns what it has; throws Interrupted if asked to stop.
BoundedResult search_with_bound(const BoundedSearch& search, const Deadline& deadline);

}  // namespace roadfix
