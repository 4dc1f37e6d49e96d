// One level of the pyramid that a search goes down: the feature map, positions, headings and scales at one cell size.
#pragma once

#include "core/grid/feature_rotator.hpp"
#include "core/match/heading_bins.hpp"
#include "core/match/lattice_pose.hpp"
#include "core/match/scales.hpp"
#include "core/match/score.hpp"
#include "core/search/search.hpp"

namespace roadfix {

/// The feature map in the cells of a level, at one scale.
struct LevelFeatures {
  FeatureMap map;
  FeatureRotator rotator;
  FootprintCells cells;

  explicit LevelFeatures(FeatureMap features);
};

struct Level {
  const GridReader& read;
  const FeatureMap& source;  ///< what the search was given
  LevelFeatures features;    ///< in the cells of this level, as large as it was given
  HeadingBins bins{2};
  Scales scales;
  int threads = 1;

  double cell_m() const { return features.map.cell_m; }
  LevelFeatures at_scale(int index) const;
  /// Cells that the footprint reaches at a scale.
  int reach(int scale) const;
  GridPose pose_of(const LatticePose& pose) const;
};

}  // namespace roadfix
