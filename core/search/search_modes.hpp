// The last step of a search: its best candidates within the cell, and what is left as the background.
#pragma once

#include <optional>
#include <vector>

#include "core/search/search_levels.hpp"
#include "core/search/search_scan.hpp"

namespace roadfix {

/// Poses of the finest level, distinct and best first, of the ground that was scanned.
struct RankedPoses {
  std::vector<LatticePose> inside;  ///< the region
  std::vector<LatticePose> around;

  RankedPoses(const SearchLevels& levels, const std::vector<LatticePose>& poses);
};

/// Sets what the places beside the best one tell of chance.
void set_rivals(const SearchLevels& levels, const SearchScan& scan, const SearchOptions& options,
                const RankedPoses& poses, ScoreBackground& background);

/// As in SearchResult.
struct FoundModes {
  std::vector<SearchMode> modes;
  std::optional<double> other_roads_m;
  std::optional<SearchMode> nearby;
  std::vector<SearchMode> outside;
  bool complete = true;  ///< false where the deadline ended it, after the first mode at the earliest
};

/// Modes from the best poses within the region; those that were flanks of one peak give one.
FoundModes find_modes(const SearchLevels& levels, const SearchScan& scan, const SearchOptions& options,
                      const RankedPoses& poses, const ScoreBackground& background);

}  // namespace roadfix
