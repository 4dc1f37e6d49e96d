#include "core/proof/heading_sectors.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/units/parallel_for.hpp"

namespace roadfix {

void narrow(BlockSums& sums, const TurnedFeatures& turned) {
  sums.cells = {turned.cells, turned.cells};
  sums.feature = {turned.sum, turned.sum};
  sums.feature_square_min = turned.square;
}

void narrow(BlockSums& sums, const TurnedFeatures& turned, const PartialFeatures& observed) {
  sums.cells.max = std::min(sums.cells.max, turned.cells);
  sums.feature = {observed.sum_min, std::min(turned.sum, observed.sum_max)};
  sums.feature_square_min = observed.square_min;
}

void narrow(BlockSums& sums, const TurnedFeatures& turned, const GroundRange& ground) {
  if (ground.cells.min == turned.cells) narrow(sums, turned);
  sums.cells = ground.cells;
  sums.map = ground.value;
  sums.map_square_min = ground.square_min;
  sums.map_mixed_max = ground.mixed_max;
}

bool HeadingSectors::turn(const Deadline& deadline) {
  const BoundedSearch& search = problem_.search;
  const LineHints hints = find_lines(*search.features, problem_.base);
  const std::size_t count = search.headings.size();
  turned_.resize(count);
  std::atomic<bool> complete{true};
  parallel_for(static_cast<int>(count), search.threads, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    if (deadline.over()) {
      complete = false;
      return;
    }
    const Angle heading = problem_.heading(at);
    turned_[at].emplace(problem_.rotator.rotated(heading), heading, problem_.base, hints, problem_.map);
  });
  if (!complete) return false;
  for (std::size_t first = 0; first < count; first += kSectorHeadings) {
    sectors_.push_back(sector_between(first, std::min(first + kSectorHeadings, count)));
  }
  return true;
}

Sector HeadingSectors::sector_between(std::size_t first, std::size_t end) const {
  Sector sector{first, end, {}, {}, 0.0, {}};
  std::vector<const BlockCover*> covers;
  BlockSums& sums = sector.features;
  constexpr double kMax = std::numeric_limits<double>::max();
  sums.cells = {kMax, 0.0};
  sums.feature = {kMax, 0.0};
  sums.feature_square_min = kMax;
  sums.base = problem_.base;
  sums.span = problem_.map.span();
  for (std::size_t i = first; i < end; ++i) {
    const TurnedFeatures& turned = *turned_[i];
    covers.push_back(&turned.cover);
    sums.cells = {std::min(sums.cells.min, turned.cells), std::max(sums.cells.max, turned.cells)};
    sums.feature = {std::min(sums.feature.min, turned.sum), std::max(sums.feature.max, turned.sum)};
    sums.feature_square_min = std::min(sums.feature_square_min, turned.square);
  }
  const BlockCover common = common_cover(covers);
  const auto runs = [side = common.side](const std::vector<bool>& blocks) {
    const CellOffset middle{side / 2, side / 2};
    return runs_of(side, side, middle, [&](int c, int r) { return blocks[static_cast<std::size_t>(r * side + c)]; });
  };
  sector.inner = runs(common.inner);
  sector.outer = runs(common.outer);
  for (const RowRun& run : sector.outer) sector.outer_blocks += run.end - run.first;
  return sector;
}

HeadingSectors::Covered HeadingSectors::covered(const Sector& sector, const SectorRun& run, std::size_t block) {
  Covered result{sector.features, false};
  BlockSums& sums = result.sums;
  sums.map = {static_cast<double>(run.inner.value[block]), static_cast<double>(run.outer.value[block])};
  sums.map_square_min = static_cast<double>(run.inner.square[block]);
  // No term is negative, so that the sum over a footprint is at most that over all that the sector covers.
  sums.map_mixed_max = sums.span * sums.map.max - static_cast<double>(run.outer.square[block]);
  result.map_observed = run.outer.cells[block] == sector.outer_blocks * kBlockCells * kBlockCells;
  if (!result.map_observed) {
    sums.cells = {static_cast<double>(run.inner.cells[block]),
                  std::min(sums.cells.max, static_cast<double>(run.outer.cells[block]))};
    sums.feature.min = 0.0;
    sums.feature_square_min = 0.0;
  }
  return result;
}

}  // namespace roadfix
