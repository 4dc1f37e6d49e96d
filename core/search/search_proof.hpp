// The step of a search that can be asked for: a proof that no pose of the region is better, or the better pose.
#pragma once

#include <vector>

#include "core/search/search_levels.hpp"

namespace roadfix {

/// `candidates` are those of the level SearchLevels::proof_level(); the best pose of the region is appended if it
/// scores more than the best of them. What was found on the way to it is not: chance would be told by poses that only
/// the order of threads brought up. Ends after options.proof_time, or halfway to the deadline.
SearchProof prove(const SearchLevels& levels, const SearchOptions& options, std::vector<LatticePose>& candidates);

}  // namespace roadfix
