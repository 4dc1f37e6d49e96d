// A pose on the lattice of one cell size.
#pragma once

#include "core/grid/geometry.hpp"

namespace roadfix {

/// The nadir lies in this cell, the heading is this bin, the scale this index (Scales).
struct LatticePose {
  LatticeIndex cell;
  int bin = 0;
  double score = 0.0;
  int scale = 0;
};

}  // namespace roadfix
