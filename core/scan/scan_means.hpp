// The part of a scan's scores that varies slowly: means and spreads under the footprint, one for each block of cells.
#pragma once

#include <array>
#include <vector>

#include "core/match/score.hpp"
#include "core/scan/scan_map.hpp"
#include "core/scan/scan_planes.hpp"

namespace roadfix {

/// Score = (sum of products - correction) * gain, for the nadir in the middle of each block; linear in between.
struct ScanMeans {
  FloatPlane correction, gain;
};

/// How the positions of a scan, and the cells of its footprints, lie among the blocks of ScanMeans.
class BlockAlignment {
 public:
  struct Positions {
    int cols = 0;  ///< from -1 to cols: with the neighbours of the first and last one
    int rows = 0;
    int lead_col = 0;  ///< of the first one within the map
    int lead_row = 0;
  };
  BlockAlignment(const ScanMap& map, const Positions& positions);

  /// Tap i + 1: the columns or rows of ScanMeans between which position i (from -1 on) lies.
  const InterpolationTaps& col_taps(bool half_turn) const { return col_taps_[half_turn ? 1 : 0]; }
  const InterpolationTaps& row_taps(bool half_turn) const { return row_taps_[half_turn ? 1 : 0]; }
  /// Means over each block of the patch's cells (2 reach + 1 of them along an edge, the nadir in the middle).
  BlockSumPlanes block_means(const CellArray& cells, double mean) const;

 private:
  /// Blocks of the patch such that the nadir is in the middle of its block (at half_block()).
  BlockTiling patch_tiling() const;
  int half_block() const { return (block_cells_ - 1) / 2; }
  int nadir_block() const { return (reach_ + patch_tiling().lead_cells) / block_cells_; }

  int reach_;
  int block_cells_;  ///< along an edge
  std::array<InterpolationTaps, 2> col_taps_, row_taps_;
};

/// The working memory of a thread for means.
struct ScanMeansWorkspace {
  Correlator::Workspace observed, values;
  Spectrum observed_and_value, square, observed_of_patch;
  FloatPlanes counts_and_values, squares, of_map;
  explicit ScanMeansWorkspace(const ScanMap& map)
      : observed(map.block_observed().side()),
        values(map.block_values().side()),
        observed_and_value(observed.sums.side()),
        square(observed.sums.side()),
        observed_of_patch(values.sums.side()) {}
};

/// What the means need of a footprint, at one heading and its opposite.
class ScanMeansPatch {
 public:
  /// `blocks`: BlockAlignment::block_means(). All outlive this.
  ScanMeansPatch(const ScanMap& map, const BlockSumPlanes& blocks, ScanMeansWorkspace& workspace);
  /// The gain is 0 where score_of() gives no score for these cells.
  void at(bool half_turn, const FootprintCells& cells, ScanMeans& means) const;

 private:
  const ScanMap& map_;
  ScanMeansWorkspace& workspace_;
};

}  // namespace roadfix
