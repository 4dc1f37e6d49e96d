// Pictures of the ground with masks of its roads, as networks are trained on.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/grid/geometry.hpp"
#include "tiles/imagery/mosaic.hpp"
#include "tiles/sources/cell_source.hpp"

namespace roadfix {

struct TrainingPair {
  cv::Mat picture;    ///< CV_8UC3 (BGR), black where imagery or roads know nothing, and nowhere else
  cv::Mat mask;       ///< CV_8UC1: 255 = road, 0 = none or not known
  double seen = 0.0;  ///< share of the pixels of which both know something
  double road = 0.0;  ///< share of the pixels that are road
};

/// Pixels of 0.5, 1 or 2 m, about as large as those of the imagery. Networks look at pixels of about a metre.
double pair_gsd_m(double imagery_gsd_m);

/// Squares of the lattice that hold ground of both, from west to east and from north to south: the same of every
/// picture of that ground.
std::vector<GridGeometry> pair_squares(const Mosaic& imagery, const CellSource& roads, double gsd_m, int side_px);

/// Of the ground of `square`, a pixel for each of its cells. Thread-safe. Throws what reading either does.
TrainingPair training_pair(const Mosaic& imagery, const CellSource& roads, const GridGeometry& square);

}  // namespace roadfix
