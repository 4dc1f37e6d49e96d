// Overlapping tiles and the weights with which their results are blended, so that no seam shows.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

namespace roadfix {

struct TilePlan {
  int tile = 384;    ///< longest side of a tile in input pixels
  int overlap = 96;  ///< of neighbours, at most half a tile
  int stride = 2;    ///< input pixels per output cell; divides `multiple`
  int multiple = 2;  ///< divides tile, overlap, the picture's sides, and the sides of what is run
};

/// Side of the tiles along a side of `length` pixels: as few tiles as `tile` and `overlap` allow, all about as small as
/// that many may be; `length` itself where it is no longer than a tile.
int tile_side(int length, const TilePlan& plan);

/// First pixels of the tiles along a side of `length` pixels. They cover it; the last one ends at its end.
std::vector<int> tile_starts(int length, const TilePlan& plan);

/// Weight of each of `cells` output cells of a tile: 1 inside, falling to almost 0 towards the ends over the
/// overlap's middle half. Two neighbours' weights sum to 1 where both count.
std::vector<float> blend_weights(int cells, int overlap_cells);

/// Calls `run`, from several threads, with the part of each tile around what is `wanted` (CV_8UC1 of the picture's
/// size, nonzero = wanted), and blends the returned CV_32FC1 of rectangle / stride cells. Cells that nothing was run
/// for are 0.
cv::Mat blend_tiles(const cv::Mat& wanted, const TilePlan& plan, const std::function<cv::Mat(const cv::Rect&)>& run);

}  // namespace roadfix
