#include "core/match/block_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadfix {
namespace {

constexpr int kTileRows = 16;  // of blocks; with kRun columns and the footprint's reach within a core's cache

/// The feature map's sums where parts of the map are unobserved, for a run of blocks.
struct PartialSums {
  RunSums sum_least{}, sum_most{}, square_least{};
};

}  // namespace

std::vector<BlockTile> BlockScan::tiles() const {
  const GridGeometry& positions = problem_.search.positions;
  const int first_col = problem_.shift_col / kBlockCells;
  const int first_row = problem_.shift_row / kBlockCells;
  const int last_col = (problem_.shift_col + positions.cols - 1) / kBlockCells;
  const int last_row = (problem_.shift_row + positions.rows - 1) / kBlockCells;
  std::vector<BlockTile> tiles;
  for (int row = first_row; row <= last_row; row += kTileRows) {
    for (int col = first_col; col <= last_col; col += BoundMap::kRun) {
      tiles.push_back({col, row, std::min(kTileRows, last_row - row + 1)});
    }
  }
  return tiles;
}

BlockScanResult BlockScan::scan(const BlockTile& tile, const Deadline& deadline) const {
  BlockScanResult result;
  std::vector<Row> rows = rows_of(tile);
  for (const Sector& sector : headings_.sectors()) {
    if (deadline.over()) return {{}, 0, 0, false};
    cover(sector, tile, rows);
    for (std::size_t h = sector.first; h < sector.last; ++h) {
      for (std::size_t r = 0; r < rows.size(); ++r) {
        if (rows[r].hopeless) continue;
        result.blocks += BoundMap::kRun;
        scan_row(h, tile.col, tile.row + static_cast<int>(r), rows[r], result.nodes);
      }
    }
  }
  for (const Row& row : rows) {
    result.eligible += std::ranges::count(row.eligible, true) * std::ssize(problem_.search.headings);
  }
  return result;
}

std::vector<BlockScan::Row> BlockScan::rows_of(const BlockTile& tile) const {
  std::vector<Row> rows(static_cast<std::size_t>(tile.rows));
  for (int r = 0; r < tile.rows; ++r) {
    for (int i = 0; i < BoundMap::kRun; ++i) {
      rows[static_cast<std::size_t>(r)].eligible[static_cast<std::size_t>(i)] =
          problem_.block_eligible(tile.col + i, tile.row + r);
    }
  }
  return rows;
}

/// What a sector's headings cover of the map, and what they need of it.
void BlockScan::cover(const Sector& sector, const BlockTile& tile, std::vector<Row>& rows) const {
  const double goal = best_;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    Row& row = rows[r];
    const int block_row = tile.row + static_cast<int>(r);
    covered_sums(problem_.map, sector.inner, tile.col, block_row, row.run.inner);
    covered_sums(problem_.map, sector.outer, tile.col, block_row, row.run.outer);
    row.hopeless = true;
    for (std::size_t i = 0; i < BoundMap::kRun; ++i) {
      row.needed[i] = std::numeric_limits<double>::infinity();
      if (!row.eligible[i]) continue;
      const BlockSums sums = HeadingSectors::covered(sector, row.run, i).sums;
      row.needed[i] = cross_needed(sums, problem_.full_cells, problem_.search.least_cells, goal);
      const double most = (kRoad - problem_.base) * sums.map.most;
      if (row.needed[i] <= most) row.hopeless = false;
    }
  }
}

void BlockScan::scan_row(std::size_t heading, int col, int row, const Row& known, std::vector<BoundNode>& nodes) const {
  const TurnedFeatures& turned = headings_.turned(heading);
  RunSums cross;
  term_sums(problem_.map, turned.cross, col, row, cross);
  bool partial_known = false;
  PartialSums partial;
  for (std::size_t i = 0; i < BoundMap::kRun; ++i) {
    const double most = cross[i] * turned.cross.unit;
    if (most < known.needed[i]) continue;
    auto [sums, whole] = HeadingSectors::covered(headings_.sector_of(heading), known.run, i);
    sums.cross_most = most;
    if (whole) {
      sums.cells = {turned.cells, turned.cells};
      sums.feature = {turned.sum, turned.sum};
      sums.feature_square_least = turned.square;
    } else {
      if (!partial_known) {
        partial_known = true;
        term_sums(problem_.map, turned.sum_least, col, row, partial.sum_least);
        term_sums(problem_.map, turned.sum_most, col, row, partial.sum_most);
        term_sums(problem_.map, turned.square_least, col, row, partial.square_least);
      }
      sums.cells.most = std::min(sums.cells.most, turned.cells);
      sums.feature = {partial.sum_least[i] * turned.sum_least.unit,
                      std::min(turned.sum, partial.sum_most[i] * turned.sum_most.unit)};
      sums.feature_square_least = partial.square_least[i] * turned.square_least.unit;
    }
    const double bound = score_bound(sums, problem_.full_cells, problem_.search.least_cells);
    if (bound <= best_) continue;
    BoundNode node{col + static_cast<std::int32_t>(i), row, static_cast<std::int32_t>(heading),
                   std::nextafter(static_cast<float>(bound), 2.0F)};
    node.map_least = known.run.inner.value[i];
    node.map_most = known.run.outer.value[i];
    node.square_least = known.run.inner.square[i];
    node.square_most = known.run.outer.square[i];
    node.whole = whole;
    nodes.push_back(node);
  }
}

}  // namespace roadfix
