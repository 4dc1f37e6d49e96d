#include "core/scan/scan_map.hpp"

#include <algorithm>

#include "core/grid/cell_moments.hpp"
#include "core/scan/scan_planes.hpp"

namespace roadfix {
namespace {

int patch_cells(int reach) { return 2 * reach + 1; }
int patch_blocks(int reach, int block) { return (patch_cells(reach) + block - 1) / block + 1; }

constexpr int kNeighbours = 2;  // a position's, on both sides, which show whether it is a peak

}  // namespace

ScanMap::ScanMap(const RoadGrid& map, int reach, int block)
    : ScanMap(map, moments_of(map.cells).mean(), reach, block) {}

ScanMap::ScanMap(const RoadGrid& map, double mean, int reach, int block)
    : ScanMap(map, values_of(map.cells, mean), block_sums(map.cells, mean, {block, 0}), reach, block) {}

ScanMap::ScanMap(const RoadGrid& map, const FloatPlane& values, const BlockSumPlanes& blocks, int reach, int block)
    : geometry_(map.geometry),
      reach_(reach),
      block_(block),
      values_(values, {}, patch_cells(reach), kNeighbours),
      block_observed_(blocks.observed, {}, patch_blocks(reach, block)),
      block_values_(blocks.value, blocks.square, patch_blocks(reach, block)) {}

int scan_block(const FeatureMap& features) {
  return std::clamp(std::min(features.cells.cols(), features.cells.rows()) / 12, 1, 4);
}

}  // namespace roadfix
