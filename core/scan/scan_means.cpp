#include "core/scan/scan_means.hpp"

#include "core/scan/scan_kernel.hpp"
#include "core/units/floor_div.hpp"

namespace roadfix {

BlockAlignment::BlockAlignment(const ScanMap& map, const Positions& positions)
    : reach_(map.reach()), block_cells_(map.block()) {
  for (const bool half_turn : {false, true}) {
    // A block result with its nadir block at B stands for the nadir at B * block_cells + half_block, turned around at
    // B * block_cells + block_cells - 1 - half_block.
    const int centre = half_turn ? block_cells_ - 1 - half_block() : half_block();
    // The block whose result lies in the first row and column.
    const int first = half_turn ? -nadir_block() : nadir_block();
    const auto taps = [&](int count, int lead, int blocks) {
      return interpolation_taps({block_cells_, Correlator::kLead - first, blocks}, lead - 1 - centre, count + 2);
    };
    const std::size_t turn = half_turn ? 1 : 0;
    col_taps_[turn] = taps(positions.cols, positions.lead_col, map.block_values().sum_cols());
    row_taps_[turn] = taps(positions.rows, positions.lead_row, map.block_values().sum_rows());
  }
}

BlockTiling BlockAlignment::patch_tiling() const {
  const int first_cell = half_block() - reach_;  // where the block of the nadir begins at 0
  return {block_cells_, first_cell - block_cells_ * floor_div(first_cell, block_cells_)};
}

BlockSumPlanes BlockAlignment::block_means(const CellArray& cells, double mean) const {
  BlockSumPlanes sums = block_sums(cells, mean, patch_tiling());
  for (FloatPlane* plane : {&sums.observed, &sums.value, &sums.square}) {
    for (float& sum : plane->values) sum /= static_cast<float>(block_cells_ * block_cells_);
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
