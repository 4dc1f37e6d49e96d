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

/// Replaces each candidate by the best pose within the reach and +- 1 of the scales around it, as far as the score
/// rises towards it at one of these headings. False if time was over before: then they are left as they were.
bool refine(const Level& level, RefineReach reach, const Deadline& deadline, std::vector<LatticePose>& candidates);

}  // namespace roadfix
