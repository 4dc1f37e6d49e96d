// The last step of a search: its best candidates become modes, the others the background.
#pragma once

#include <optional>
#include <vector>

#include "core/search/search_levels.hpp"
#include "core/search/search_scan.hpp"

namespace roadfix {

/// Distinct poses of the finest level, each list best first.
struct RankedPoses {
  std::vector<LatticePose> inside;  ///< the region
  std::vector<LatticePose> around;  ///< on ground that was scanned around it, or at headings outside its range

  RankedPoses(const SearchLevels& levels, const std::vector<LatticePose>& poses);
};

/// Sets the rivals of the background and the region's share of them.
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

/// Modes from the best poses within the region, one for each peak.
FoundModes find_modes(const SearchLevels& levels, const SearchScan& scan, const SearchOptions& options,
                      const RankedPoses& poses, const ScoreBackground& background);

}  // namespace roadfix
