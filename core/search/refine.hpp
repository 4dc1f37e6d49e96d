// Follows a candidate of the coarse scan down to the cells of the map: exact scores of the poses around it.
#pragma once

#include <vector>

#include "core/match/deadline.hpp"
#include "core/match/lattice_pose.hpp"
#include "core/search/level.hpp"

namespace roadfix {

struct RefineReach {
  int cells;
  int bins;
};

/// Replaces each candidate by the best pose that can be reached from it uphill, at each heading and scale (+- 1) by
/// itself, within `reach`. False if time ran out: then the candidates are unchanged.
bool refine(const Level& level, RefineReach reach, const Deadline& deadline, std::vector<LatticePose>& candidates);

}  // namespace roadfix
