// The step of a search that can be asked for: a proof that no pose of the region is better, or the better pose.
#pragma once

#include <vector>

#include "core/search/search_levels.hpp"

namespace roadfix {

/// `candidates` are on the level SearchLevels::proof_level(); the best pose of the region is appended if it scores more
/// than all of them. Other poses found on the way are not: which ones depends on the order of threads, and chance is
/// estimated from the candidates. Ends after options.proof_time, or halfway to the deadline.
SearchProof prove(const SearchLevels& levels, const SearchOptions& options, std::vector<LatticePose>& candidates);

}  // namespace roadfix
