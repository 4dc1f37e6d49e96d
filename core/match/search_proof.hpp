// The step of a search that can be asked for: a proof that no pose of the region is better, or the better pose.
#pragma once

#include <vector>

#include "core/match/search_levels.hpp"

namespace roadfix {

/// At SearchLevels::proof_level(), whose candidates are given: poses that are better than the best of them within the
/// region are added. Ends after options.proof_time, or halfway to the deadline.
SearchProof prove(const SearchLevels& levels, const SearchOptions& options, std::vector<LatticePose>& candidates);

}  // namespace roadfix
