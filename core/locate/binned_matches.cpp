#include "core/locate/binned_matches.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/grid/turnable_map.hpp"
#include "core/match/coarse_scan.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/work.hpp"

namespace roadfix {
namespace {

constexpr int kBlockBits = 10;  // poses in a block of 1024 x 1024 cells share one read of the map

std::pair<int, int> block_of(const BinnedPose& pose) {
  return {pose.cell.col >> kBlockBits, pose.cell.row >> kBlockBits};
}

/// In the order of their keys, 0 to keys - 1; those of a key in the order that they had.
template <typename KeyOf>
std::vector<BinnedPose> by_key(std::span<const BinnedPose> poses, std::size_t keys, KeyOf key_of) {
  std::vector<std::size_t> next(keys + 1, 0);
  for (const BinnedPose& pose : poses) ++next[key_of(pose) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<BinnedPose> result(poses.size());
  for (const BinnedPose& pose : poses) result[next[key_of(pose)]++] = pose;
  return result;
}

/// Block by block, within a block heading by heading, and those a quarter turn apart behind each other.
std::vector<BinnedPose> in_order(std::span<const BinnedPose> poses, const HeadingBins& bins) {
  const int quarter = bins.count() / 4;
  std::vector<std::pair<int, int>> blocks;
  for (const BinnedPose& pose : poses) {
    if (blocks.empty() || block_of(pose) != blocks.back()) blocks.push_back(block_of(pose));
  }
  std::ranges::sort(blocks);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  auto sorted = by_key(poses, static_cast<std::size_t>(bins.count()), [&](const BinnedPose& pose) {
    return static_cast<std::size_t>(pose.bin % quarter * 4 + pose.bin / quarter);
  });
  if (blocks.size() < 2) return sorted;
  return by_key(sorted, blocks.size(), [&](const BinnedPose& pose) {
    return static_cast<std::size_t>(std::ranges::lower_bound(blocks, block_of(pose)) - blocks.begin());
  });
}

/// Runs of equal neighbours.
template <typename Same>
std::vector<std::span<const BinnedPose>> runs(std::span<const BinnedPose> poses, Same same) {
  std::vector<std::span<const BinnedPose>> result;
  for (std::size_t first = 0; first < poses.size();) {
    std::size_t last = first + 1;
    while (last < poses.size() && same(poses[first], poses[last])) ++last;
    result.push_back(poses.subspan(first, last - first));
    first = last;
  }
  return result;
}

GridGeometry around(std::span<const BinnedPose> poses, double cell_m, int reach) {
  LatticeIndex low = poses.front().cell;
  LatticeIndex high = low;
  for (const BinnedPose& pose : poses) {
    low = {std::min(low.col, pose.cell.col), std::min(low.row, pose.cell.row)};
    high = {std::max(high.col, pose.cell.col), std::max(high.row, pose.cell.row)};
  }
  return {cell_m,
          {low.col - reach, low.row - reach},
          high.col - low.col + 1 + 2 * reach,
          high.row - low.row + 1 + 2 * reach};
}

/// All at one heading. `origin` is the plane's first cell.
void match_at_heading(const MapPlane& plane, LatticeIndex origin, const Footprint& footprint,
                      std::span<const BinnedPose> poses, std::span<MatchSums> sums) {
  std::vector<PlaneCell> places;
  for (const BinnedPose& pose : poses) places.push_back({pose.cell.col - origin.col, pose.cell.row - origin.row});
  std::vector<MatchSums> found(places.size());
  match_sums(plane, footprint, places, found);
  for (std::size_t k = 0; k < poses.size(); ++k) sums[poses[k].index] = found[k];
}

}  // namespace

void match_binned(const MapView& map, const FeatureMap& features, const HeadingBins& bins,
                  std::span<const BinnedPose> poses, int threads, const std::stop_token& stop,
                  std::span<MatchSums> sums) {
  assert(bins.count() % 4 == 0);
  const int quarter = bins.count() / 4;
  const int reach = footprint_reach(features);
  const TurnableMap turnable(features);
  const Deadline deadline(stop, {});
  const std::vector<BinnedPose> sorted = in_order(poses, bins);
  for (const auto block : runs(sorted, [](const auto&a, const auto&b) { return block_of(a) == block_of(b); })) {
    const GridGeometry window = around(block, features.cell_m, reach);
    const MapPlane plane(map.read(window).cells, 0);
    const auto families = runs(block, [&](const auto& a, const auto& b) { return a.bin % quarter == b.bin % quarter; });
    parallel_for(static_cast<int>(families.size()), threads, [&](int task) {
      const auto family = families[static_cast<std::size_t>(task)];
      int bin = family.front().bin % quarter;
      FeatureMap turned = turnable.at(bins.heading(bin));
      for (const auto members : runs(family, [](const auto&a, const auto&b) { return a.bin == b.bin; })) {
        deadline.check();
        for (; bin < members.front().bin; bin += quarter) turned = quarter_turned(turned);
        match_at_heading(plane, window.origin, Footprint(turned), members, sums);
      }
    });
  }
}

}  // namespace roadfix
