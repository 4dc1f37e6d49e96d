// The exhaustive part of the search: the score of every position of a window at every heading bin, by FFT correlation.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/grid/feature_map.hpp"
#include "core/grid/road_grid.hpp"
#include "core/match/deadline.hpp"
#include "core/match/heading_bins.hpp"
#include "core/scan/scan_map.hpp"

namespace roadfix {

/// A cell of the scanned geometry at a heading bin.
struct ScanPose {
  int col = 0;
  int row = 0;
  int bin = 0;
  float score = 0.0F;
};

struct ScanRequest {
  GridGeometry positions;  ///< cells whose centres are scanned
  HeadingBins bins{2};
  std::vector<int> headings;                       ///< bins to scan, ascending
  std::function<bool(int col, int row)> eligible;  ///< cells of `positions` that count at all
  std::size_t keep = 4096;                         ///< best local maxima (within a heading) to return
  int threads = 1;
  std::function<void(std::size_t headings)> scanned;  ///< progress: called from any thread, but one at a time
};

struct ScanResult {
  std::vector<ScanPose> maxima;  ///< best first
  double score_square_sum = 0.0;
  std::int64_t poses = 0;
  double share = 1.0;  ///< of the headings scanned before the deadline
};

/// `map` extends its reach() beyond the positions on every side; its reach is at least the footprint's. Scores are
/// accurate to some percent: means and spreads under the footprint come from a coarser grid. On bare ground beside
/// roads, and under narrow footprints, they may be several times too high, beyond 1. At the deadline it stops
/// and returns what it has; throws Interrupted if asked to stop.
ScanResult coarse_scan(const ScanMap& map, const FeatureMap& features, const ScanRequest& request,
                       const Deadline& deadline);

}  // namespace roadfix
