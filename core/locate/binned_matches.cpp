#include "core/locate/binned_matches.hpp"

#include <algorithm>
#include <tuple>

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
                  std::vector<BinnedPose> poses, int threads, const std::stop_token& stop, std::span<MatchSums> sums) {
  const int reach = footprint_reach(features);
  const Deadline deadline(stop, {});
  std::ranges::sort(poses, [](const BinnedPose& a, const BinnedPose& b) {
    return std::tuple(block_of(a), a.bin, a.index) < std::tuple(block_of(b), b.bin, b.index);
  });
  for (const auto block : runs(poses, [](const auto&a, const auto&b) { return block_of(a) == block_of(b); })) {
    const GridGeometry window = around(block, features.cell_m, reach);
    const MapPlane plane(map.read(window).cells, 0);
    const auto by_bin = runs(block, [](const auto& a, const auto& b) { return a.bin == b.bin; });
    parallel_for(static_cast<int>(by_bin.size()), threads, [&](int task) {
      deadline.check();
      const auto members = by_bin[static_cast<std::size_t>(task)];
      const Footprint footprint = footprint_at(features, bins.heading(members.front().bin));
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
