// Which ground is still free: a raster of one metre a cell that streets, water and buildings are entered into.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "tiles/world/plan.hpp"

namespace roadfix::world {

class Site {
 public:
  /// Enters streets with their sidewalks, and the river.
  explicit Site(const Plan& plan);

  /// Number of the block at a point, counted from 1; 0 on streets, in water and outside the picture.
  int block_at(PlanPoint p) const;
  bool is_free(PlanPoint p) const;
  /// Whether all of the footprint is free ground of the block.
  bool has_room(const Footprint& footprint, int block) const;
  void occupy(const Footprint& footprint);

  /// Outline and area of each block; element i is block number i + 1.
  std::vector<Block> blocks() const;

 private:
  cv::Rect cells_of(const Footprint& footprint) const;

  cv::Mat1i block_;
  cv::Mat1i stats_;  ///< of each block, as OpenCV's connected components give them
  cv::Mat1b taken_;
};

double sidewalk_m(const Street& street);

}  // namespace roadfix::world
