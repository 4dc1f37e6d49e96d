#include "core/match/scan_means.hpp"

#include "core/match/scan_kernel.hpp"

namespace roadfix {

ScanMeansGrid::ScanMeansGrid(const ScanMap& map, const Positions& positions) : reach_(map.reach()), q_(map.block()) {
  for (const bool half_turn : {false, true}) {
    // A block result with its nadir block at B stands for the nadir at B * q + half_block, turned around at
    // B * q + q - 1 - half_block.
    const int centre = half_turn ? q_ - 1 - half_block() : half_block();
    // The block whose result lies in the first row and column.
    const int first = half_turn ? -nadir_block() : nadir_block();
    const int offset = Correlator::kLead - first;
    const auto along = [&](int count, int lead, int blocks) {
      return mixes(count + 2, lead - 1 - centre, q_, offset, blocks);
    };
    cols_[half_turn ? 1 : 0] = along(positions.cols, positions.lead_col, map.block_values().sum_cols());
    rows_[half_turn ? 1 : 0] = along(positions.rows, positions.lead_row, map.block_values().sum_rows());
  }
}

BlockSumPlanes ScanMeansGrid::block_means(const CellArray& cells, double mean) const {
  BlockSumPlanes sums = block_sums(cells, mean, q_, block_lead());
  for (FloatPlane* plane : {&sums.observed, &sums.value, &sums.square}) {
    for (float& sum : plane->values) sum /= static_cast<float>(q_ * q_);
  }
  return sums;
}

ScanMeansPatch::ScanMeansPatch(const ScanMap& map, const BlockSumPlanes& blocks, ScanMeansWorkspace& workspace)
    : map_(map), workspace_(workspace) {
  map.block_observed().spectrum_of(blocks.observed, blocks.value, workspace.observed, workspace.observed_and_value);
  map.block_observed().spectrum_of(blocks.square, {}, workspace.observed, workspace.square);
  map.block_values().spectrum_of(blocks.observed, {}, workspace.values, workspace.observed_of_patch);
}

void ScanMeansPatch::at(bool half_turn, const FootprintCells& cells, ScanMeans& means) const {
  map_.block_observed().correlate(workspace_.observed_and_value, half_turn, workspace_.observed,
                                  workspace_.counts_and_values);
  map_.block_observed().correlate(workspace_.square, half_turn, workspace_.observed, workspace_.squares);
  map_.block_values().correlate(workspace_.observed_of_patch, half_turn, workspace_.values, workspace_.of_map);
  const FloatPlane& n = workspace_.counts_and_values.first;
  means.correction.resize(n.cols, n.rows);
  means.gain.resize(n.cols, n.rows);
  const BlockRow sums{n.values.data(), workspace_.counts_and_values.second.values.data(),
                      workspace_.squares.first.values.data(), workspace_.of_map.first.values.data(),
                      workspace_.of_map.second.values.data()};
  const MeansLimits limits{static_cast<float>(cells.full), static_cast<float>(cells.min),
                           static_cast<float>(kMinVariance)};
  means_of_blocks(sums, limits, static_cast<int>(n.values.size()), means.correction.values.data(),
                  means.gain.values.data());
}

}  // namespace roadfix
