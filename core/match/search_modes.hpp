// The last step of a search: its best candidates within the cell, and what is left as the background.
#pragma once

#include <vector>

#include "core/match/deadline.hpp"
#include "core/match/search_levels.hpp"
#include "core/match/search_scan.hpp"

namespace roadfix {

/// Sets the modes of the result, from the best candidates within the region, and its background: the scores of all
/// others. `candidates` are poses of the finest level, distinct and best first, of the ground that `scan` went over.
/// Candidates that were flanks of one peak give one mode. At the deadline it ends after the first mode.
void rank(const SearchLevels& levels, const SearchScan& scan, const SearchOptions& options, const Deadline& deadline,
          const std::vector<LatticePose>& candidates, SearchResult& result);

}  // namespace roadfix
