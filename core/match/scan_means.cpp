#include "core/match/scan_means.hpp"

#include <cmath>

#include "core/match/score.hpp"

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

FloatPlane ScanMeansGrid::block_means(const FloatPlane& cells) const {
  FloatPlane sums = block_sums(cells, q_, block_lead());
  for (float& sum : sums.values) sum /= static_cast<float>(q_ * q_);
  return sums;
}

ScanMeansPatch::ScanMeansPatch(const ScanMap& map, const ScanMeansGrid& grid, const ScanPlanes& patch)
    : map_(map),
      observed_and_value_(
          map.block_observed().spectrum_of(grid.block_means(patch.observed), grid.block_means(patch.value))),
      square_(map.block_observed().spectrum_of(grid.block_means(patch.square), {})),
      observed_(map.block_values().spectrum_of(grid.block_means(patch.observed), {})) {}

ScanMeans ScanMeansPatch::at(bool half_turn, double full_cells, double least_cells) const {
  const auto [n, l] = map_.block_observed().correlate(observed_and_value_, half_turn);
  const FloatPlane ll = map_.block_observed().correlate(square_, half_turn).first;
  const auto [m, mm] = map_.block_values().correlate(observed_, half_turn);
  ScanMeans means{FloatPlane(n.cols, n.rows), FloatPlane(n.cols, n.rows)};
  for (std::size_t i = 0; i < n.values.size(); ++i) {
    const auto cells = static_cast<double>(n.values[i]);
    if (cells < least_cells) continue;
    const auto m_sum = static_cast<double>(m.values[i]);
    const auto l_sum = static_cast<double>(l.values[i]);
    const double map_spread = static_cast<double>(mm.values[i]) - m_sum * m_sum / cells;
    const double feature_spread = static_cast<double>(ll.values[i]) - l_sum * l_sum / cells;
    if (map_spread < kLeastSpread * cells || feature_spread < kLeastSpread * cells) continue;
    means.correction.values[i] = static_cast<float>(m_sum * l_sum / cells);
    means.gain.values[i] = static_cast<float>(std::sqrt(cells / full_cells / (map_spread * feature_spread)));
  }
  return means;
}

}  // namespace roadfix
