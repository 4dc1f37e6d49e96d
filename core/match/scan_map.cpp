#include "core/match/scan_map.hpp"

#include <algorithm>

#include "core/match/scan_planes.hpp"

namespace roadfix {
namespace {

int patch_cells(int reach) { return 2 * reach + 1; }
int patch_blocks(int reach, int block) { return (patch_cells(reach) + block - 1) / block + 1; }

Correlator values_of(const RoadGrid& map, int reach) {
  constexpr int kNeighbours = 2;  // peaks are told by both sides of a position
  return {planes_of(map.cells, mean_of(map.cells)).value, {}, patch_cells(reach), kNeighbours};
}
Correlator block_observed_of(const RoadGrid& map, int reach, int block) {
  return {block_sums(planes_of(map.cells, 0.0).observed, block, 0), {}, patch_blocks(reach, block)};
}
Correlator block_values_of(const RoadGrid& map, int reach, int block) {
  const ScanPlanes planes = planes_of(map.cells, mean_of(map.cells));
  return {block_sums(planes.value, block, 0), block_sums(planes.square, block, 0), patch_blocks(reach, block)};
}

}  // namespace

ScanMap::ScanMap(const RoadGrid& map, int reach, int block)
    : geometry_(map.geometry),
      reach_(reach),
      block_(block),
      values_(values_of(map, reach)),
      block_observed_(block_observed_of(map, reach, block)),
      block_values_(block_values_of(map, reach, block)) {}

int scan_block(const FeatureMap& features) {
  return std::clamp(std::min(features.cells.cols(), features.cells.rows()) / 12, 1, 4);
}

}  // namespace roadfix
