#include "core/locate/binned_matches.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

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

/// Block by block, and within a block heading by heading.
std::vector<BinnedPose> in_order(std::span<const BinnedPose> poses, const HeadingBins& bins) {
  std::vector<std::pair<int, int>> blocks;
  for (const BinnedPose& pose : poses) {
    if (blocks.empty() || block_of(pose) != blocks.back()) blocks.push_back(block_of(pose));
  }
  std::ranges::sort(blocks);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  auto sorted = by_key(poses, static_cast<std::size_t>(bins.count()),
                       [](const BinnedPose& pose) { return static_cast<std::size_t>(pose.bin); });
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

}  // namespace

void match_binned(const MapView& map, const FeatureMap& features, const HeadingBins& bins,
                  std::span<const BinnedPose> poses, int threads, const std::stop_token& stop,
                  std::span<MatchSums> sums) {
  const int reach = footprint_reach(features);
  const TurnableMap turnable(features);
  const Deadline deadline(stop, {});
  const std::vector<BinnedPose> sorted = in_order(poses, bins);
  for (const auto block : runs(sorted, [](const auto&a, const auto&b) { return block_of(a) == block_of(b); })) {
    const GridGeometry window = around(block, features.cell_m, reach);
    const MapPlane plane(map.read(window).cells, 0);
    const auto by_bin = runs(block, [](const auto& a, const auto& b) { return a.bin == b.bin; });
    parallel_for(static_cast<int>(by_bin.size()), threads, [&](int task) {
      deadline.check();
      const auto members = by_bin[static_cast<std::size_t>(task)];
      const Footprint footprint = footprint_at(turnable, bins.heading(members.front().bin));
      std::vector<PlaneCell> places;
      for (const BinnedPose& pose : members) {
        places.push_back({pose.cell.col - window.origin.col, pose.cell.row - window.origin.row});
      }
      std::vector<MatchSums> found(places.size());
      match_sums(plane, footprint, places, found);
      for (std::size_t k = 0; k < members.size(); ++k) sums[members[k].index] = found[k];
    });
  }
}

}  // namespace roadfix
