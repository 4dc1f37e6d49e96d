#include "core/proof/block_scan.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/match/footprint.hpp"

namespace roadfix {
namespace {

constexpr int kTileRows = 16;  // of blocks; with kRun columns and the footprint's reach within a core's cache

/// The feature map's sums where parts of the map are unobserved, for a run of blocks.
struct PartialSums {
  RunSums sum_min{}, sum_max{}, square_min{};

  PartialFeatures at(const TurnedFeatures& turned, std::size_t i) const {
    return {sum_min[i] * turned.sum_min.unit, sum_max[i] * turned.sum_max.unit, square_min[i] * turned.square_min.unit};
  }
};

PartialSums partial_sums(const BoundMap& map, const TurnedFeatures& turned, int col, int row) {
  PartialSums sums;
  term_sums(map, turned.sum_min, col, row, sums.sum_min);
  term_sums(map, turned.sum_max, col, row, sums.sum_max);
  term_sums(map, turned.square_min, col, row, sums.square_min);
  return sums;
}

// Exact sums are given up on if they exclude hardly any blocks, as in a grid of streets where every block fits as well.
constexpr int kTriedAtLeast = 64;
constexpr int kTriedForOne = 10;

}  // namespace

bool BlockScan::Ground::is_worth_its_time() const { return tried < kTriedAtLeast || kTriedForOne * excluded >= tried; }

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
  Ground ground{ground_below(tile)};
  for (const Sector& sector : headings_.sectors()) {
    if (deadline.over()) return {{}, 0, false};
    cover(sector, tile, rows);
    for (std::size_t h = sector.first; h < sector.end; ++h) {
      for (std::size_t r = 0; r < rows.size(); ++r) {
        if (rows[r].excluded) continue;
        scan_row(h, tile.col, tile.row + static_cast<int>(r), rows[r], ground, result.nodes);
      }
    }
  }
  result.eligible = eligible(rows);
  return result;
}

std::int64_t BlockScan::eligible(const std::vector<Row>& rows) const {
  std::int64_t blocks = 0;
  for (const Row& row : rows) blocks += std::ranges::count(row.eligible, true);
  return blocks * std::ssize(problem_.search.headings);
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

/// Sets for each row of blocks what a sector's headings cover of the map, and the cross sum that they need.
void BlockScan::cover(const Sector& sector, const BlockTile& tile, std::vector<Row>& rows) const {
  const double goal = floor_;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    Row& row = rows[r];
    const int block_row = tile.row + static_cast<int>(r);
    covered_sums(problem_.map, sector.inner, tile.col, block_row, row.run.inner);
    covered_sums(problem_.map, sector.outer, tile.col, block_row, row.run.outer);
    row.excluded = true;
    for (std::size_t i = 0; i < BoundMap::kRun; ++i) {
      row.needed[i] = std::numeric_limits<double>::infinity();
      if (!row.eligible[i]) continue;
      const BlockSums sums = HeadingSectors::covered(sector, row.run, i).sums;
      row.needed[i] = cross_needed(sums, problem_.search.cells, goal);
      const double reachable = (kRoad - problem_.base) * sums.map.max;
      if (row.needed[i] <= reachable) row.excluded = false;
    }
  }
}

GroundSums BlockScan::ground_below(const BlockTile& tile) const {
  const int reach = footprint_reach(*problem_.search.features);
  return {problem_.map, kBlockCells * tile.col - reach, kBlockCells * tile.row - reach,
          kBlockCells * BoundMap::kRun + 2 * reach, kBlockCells * tile.rows + 2 * reach};
}

void BlockScan::scan_row(std::size_t heading, int col, int row, const Row& known, Ground& ground,
                         std::vector<BoundNode>& nodes) const {
  const TurnedFeatures& turned = headings_.turned(heading);
  RunSums cross;
  term_sums(problem_.map, turned.cross, col, row, cross);
  std::optional<PartialSums> partial;
  for (std::size_t i = 0; i < BoundMap::kRun; ++i) {
    const double cross_max = cross[i] * turned.cross.unit;
    if (cross_max < known.needed[i]) continue;
    auto [sums, map_observed] = HeadingSectors::covered(headings_.sector_of(heading), known.run, i);
    sums.cross_max = cross_max;
    if (map_observed) {
      narrow(sums, turned);
    } else {
      if (!partial) partial = partial_sums(problem_.map, turned, col, row);
      narrow(sums, turned, partial->at(turned, i));
    }
    double bound = problem_.bound_of(sums);
    if (bound <= floor_) continue;
    const int block_col = col + static_cast<int>(i);
    if (ground.is_worth_its_time()) {
      narrow(sums, turned, ground.sums.below(turned.runs, block_col, row));
      bound = problem_.bound_of(sums);
      ++ground.tried;
      if (bound <= floor_) {
        ++ground.excluded;
        continue;
      }
    }
    nodes.push_back(
        {block_col, row, static_cast<std::int32_t>(heading), std::nextafter(static_cast<float>(bound), 2.0F), sums});
  }
}

}  // namespace roadfix
