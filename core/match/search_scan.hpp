// The first step of a search: every pose of the region, and of its surroundings where it is small, at the coarsest
// level.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/match/coarse_scan.hpp"
#include "core/match/search_levels.hpp"

namespace roadfix {

class SearchScan {
 public:
  SearchScan(const SearchLevels& levels, const SearchOptions& options);

  /// Candidates, distinct and best first: those within the region and, where it was enlarged, as many from around it.
  /// Sets what the result says of the scan. At the deadline it ends with what it has.
  std::vector<LatticePose> candidates(const Deadline& deadline, SearchResult& result) const;

  /// Places nearer than this are one.
  double separation_m() const { return separation_m_; }
  const PoseRegion& scanned() const { return scanned_; }

 private:
  PoseRegion at_more_headings() const;
  PoseRegion enlarged() const;
  ScanRequest request() const;
  std::shared_ptr<const ScanMap> map_below(const GridGeometry& positions) const;
  std::optional<double> finer_spread(const Deadline& deadline) const;

  const SearchLevels& levels_;
  const SearchOptions& options_;
  double separation_m_;
  PoseRegion scanned_;
};

}  // namespace roadfix
