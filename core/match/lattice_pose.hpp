// A pose on the lattice of one cell size.
#pragma once

#include <tuple>

#include "core/grid/geometry.hpp"
#include "core/match/heading_bins.hpp"

namespace roadfix {

/// The cell that the nadir lies in, the bin of the heading, and the index of the scale in Scales.
struct LatticePose {
  LatticeIndex cell;
  int bin = 0;
  double score = 0.0;
  int scale_step = 0;
};

/// A total order of poses at one scale, so that the best one does not depend on the order of threads.
inline bool is_better(const LatticePose& a, const LatticePose& b) {
  return std::tie(b.score, a.bin, a.cell.row, a.cell.col) < std::tie(a.score, b.bin, b.cell.row, b.cell.col);
}

/// The middle of its cell.
inline GridPose grid_pose_of(const LatticePose& pose, double cell_m, const HeadingBins& bins) {
  return {{(pose.cell.col + 0.5) * cell_m, -(pose.cell.row + 0.5) * cell_m}, bins.heading(bins.wrapped(pose.bin))};
}

}  // namespace roadfix
