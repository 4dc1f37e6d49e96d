// The first step of a search: the scores of every pose of the region, and of its surroundings, at the coarsest level.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/scan/coarse_scan.hpp"
#include "core/search/search_levels.hpp"

namespace roadfix {

struct Scanned {
  /// Distinct poses: those within the region, best first, then those from around it, best first.
  std::vector<LatticePose> candidates;
  double sd = 0.0;         ///< see ScoreBackground
  std::int64_t poses = 0;  ///< that were scored
  double share = 1.0;      ///< of all poses, that were scored before the deadline
  int headings = 0;        ///< bins within the range
};

class SearchScan {
 public:
  SearchScan(const SearchLevels& levels, const SearchOptions& options);

  /// At the deadline it ends with what it has.
  Scanned run() const;

  /// Places nearer than this are one.
  double separation_m() const { return separation_m_; }
  const PoseRegion& scanned() const { return scanned_; }

 private:
  /// What coarse scans at all scales found together.
  struct Maxima {
    std::vector<LatticePose> inside;  ///< the region
    std::vector<LatticePose> outside;
    double score_square_sum = 0.0;
    std::int64_t poses = 0;
    double share = 0.0;
    std::size_t headings = 0;
  };
  PoseRegion at_more_headings() const;
  PoseRegion enlarged() const;
  ScanRequest request() const;
  std::shared_ptr<const ScanMap> map_below(const GridGeometry& positions) const;
  Maxima maxima() const;
  /// Replaces scores that are not possible by exact ones.
  void correct(std::vector<LatticePose>& poses) const;
  std::optional<double> finer_spread() const;

  const SearchLevels& levels_;
  const SearchOptions& options_;
  double separation_m_;
  PoseRegion scanned_;
};

}  // namespace roadfix
