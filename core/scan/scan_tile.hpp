// A coarse scan on one tile of the map: from its sums to the scores of its positions, and their local maxima.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/scan/coarse_scan.hpp"
#include "core/scan/correlator.hpp"
#include "core/scan/scan_means.hpp"
#include "core/units/index_range.hpp"

namespace roadfix {

/// A pair of neighbouring headings as they are, or both turned by half a turn. The two share means and spreads under
/// the footprint, which hardly differ between them, and are the two parts of one complex transform.
struct ScanDirection {
  bool half_turn = false;
  std::array<std::optional<int>, 2> bins{};  ///< nullopt for one that is not asked for

  std::size_t count() const;
};

/// The working memory of a thread.
struct ScanBuffers {
  Spectrum cross;  ///< of the pair's footprints
  Correlator::Workspace workspace;
  ScanMeansWorkspace means_workspace;
  std::array<ScanMeans, 2> means;  ///< of the headings as they are, and turned by half a turn
  FloatPlane correction, gain, scores;
  std::vector<int> peaks;

  explicit ScanBuffers(const ScanMap& map);
};

/// What scans of some headings found.
struct ScanFindings {
  std::vector<ScanPose> maxima;
  double squares = 0.0;
  std::int64_t poses = 0;
  std::size_t headings = 0;
};

/// Thread-safe.
class TileScan {
 public:
  /// Both outlive it.
  TileScan(const ScanMap& map, const ScanRequest& request);

  const BlockAlignment& alignment() const { return alignment_; }
  /// Adds the maxima above `floor`, and the squares of all scores, to `found`. `buffers` hold the spectrum of the
  /// footprints (cross) and their means in this direction.
  void scan(std::size_t tile, const ScanDirection& direction, float floor, ScanBuffers& buffers,
            ScanFindings& found) const;

 private:
  /// From -1 to cols or rows of the request, so that each of its positions has its neighbours in some tile.
  struct Positions {
    IndexRange cols, rows;
  };
  struct Cross {
    const float* sums;
    std::ptrdiff_t stride;
    float scale;
  };
  void interpolate_means(bool half_turn, const Positions& at, ScanBuffers& buffers) const;
  void score(bool half_turn, const Positions& at, const Cross& cross, ScanBuffers& buffers) const;
  static void interpolate_cols(const FloatPlane& blocks, const InterpolationTaps& taps, IndexRange cols,
                               IndexRange rows, FloatPlane& out);
  static void collect(int bin, const Positions& at, float floor, ScanBuffers& buffers, ScanFindings& found);

  const ScanMap& map_;
  const ScanRequest& request_;
  int lead_col_;  ///< of the positions within the map
  int lead_row_;
  BlockAlignment alignment_;
  FloatPlane eligible_;  ///< 1 or 0; from position (-1, -1) on
};

}  // namespace roadfix
