// The map's side of a coarse scan: its planes transformed once, for feature maps of any heading and scale.
#pragma once

#include "core/grid/feature_map.hpp"
#include "core/grid/road_grid.hpp"
#include "core/scan/correlator.hpp"
#include "core/scan/scan_planes.hpp"

namespace roadfix {

/// Thread-safe.
class ScanMap {
 public:
  /// For footprints of up to `reach` cells (footprint_reach()). Means and spreads are computed per block of
  /// block x block cells: see scan_block().
  ScanMap(const RoadGrid& map, int reach, int block);

  const GridGeometry& geometry() const { return geometry_; }
  int reach() const { return reach_; }
  int block() const { return block_; }
  /// Of cells: values less their mean.
  const Correlator& values() const { return values_; }
  /// Of blocks: numbers of observed cells; sums of their values, and of their squares.
  const Correlator& block_observed() const { return block_observed_; }
  const Correlator& block_values() const { return block_values_; }
  std::size_t bytes() const { return values_.bytes() + block_observed_.bytes() + block_values_.bytes(); }

 private:
  ScanMap(const RoadGrid& map, double mean, int reach, int block);
  ScanMap(const RoadGrid& map, const FloatPlane& values, const BlockSumPlanes& blocks, int reach, int block);

  GridGeometry geometry_;
  int reach_;
  int block_;
  Correlator values_, block_observed_, block_values_;
};

/// Side of a block, in cells, that is small compared with the footprint.
int scan_block(const FeatureMap& features);

}  // namespace roadfix
