#include "core/locate/binned_matches.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "core/grid/feature_rotator.hpp"
#include "core/grid/resample.hpp"
#include "core/match/deadline.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/quarter_planes.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

constexpr int kBlockBits = 10;  // poses in a block of 1024 x 1024 cells share one read of the map
constexpr int kStripBits = 6;   // and follow each other along strips of 64 rows, by steps of 16 columns:
constexpr int kStepBits = 4;    // what lies below one of them lies largely below the next

std::pair<int, int> block_of(const BinnedPose& pose) {
  return {pose.cell.col >> kBlockBits, pose.cell.row >> kBlockBits};
}

constexpr std::size_t kSteps = std::size_t{1} << (2 * kBlockBits - kStripBits - kStepBits);

/// Within the block, 0 to kSteps - 1.
std::size_t step_of(const BinnedPose& pose) {
  constexpr unsigned kWithin = (1U << kBlockBits) - 1;
  const unsigned strip = (static_cast<unsigned>(pose.cell.row) & kWithin) >> kStripBits;
  const unsigned step = (static_cast<unsigned>(pose.cell.col) & kWithin) >> kStepBits;
  return (strip << (kBlockBits - kStepBits)) + step;
}

/// For each heading its place in an order in which headings a quarter turn apart are neighbours.
std::vector<std::size_t> by_quarters(const HeadingBins& bins) {
  std::vector<std::size_t> places(static_cast<std::size_t>(bins.count()));
  const std::size_t quarter = places.size() / 4;
  for (std::size_t bin = 0; bin < places.size(); ++bin) places[bin] = bin % quarter * 4 + bin / quarter;
  return places;
}

/// Puts the poses in the order of their keys, 0 to keys - 1; those of a key keep the order that they had.
template <typename KeyOf>
void sort_by(std::vector<BinnedPose>& poses, std::vector<BinnedPose>& spare, std::size_t keys, KeyOf key_of) {
  std::vector<std::size_t> next(keys + 1, 0);
  for (const BinnedPose& pose : poses) ++next[key_of(pose) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  spare.resize(poses.size());
  for (const BinnedPose& pose : poses) spare[next[key_of(pose)]++] = pose;
  poses.swap(spare);
}

/// By blocks, within a block by headings in the order of by_quarters(), within a heading by strips and steps.
void put_in_order(std::vector<BinnedPose>& poses, const HeadingBins& bins) {
  std::vector<std::pair<int, int>> blocks;
  for (const BinnedPose& pose : poses) {
    if (blocks.empty() || block_of(pose) != blocks.back()) blocks.push_back(block_of(pose));
  }
  std::ranges::sort(blocks);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  std::vector<BinnedPose> spare;
  const std::vector<std::size_t> headings = by_quarters(bins);
  sort_by(poses, spare, kSteps, step_of);
  sort_by(poses, spare, headings.size(),
          [&](const BinnedPose& pose) { return headings[static_cast<std::size_t>(pose.bin)]; });
  if (blocks.size() < 2) return;
  sort_by(poses, spare, blocks.size(), [&](const BinnedPose& pose) {
    return static_cast<std::size_t>(std::ranges::lower_bound(blocks, block_of(pose)) - blocks.begin());
  });
}

using Poses = std::span<const BinnedPose>;

/// Runs of equal neighbours.
template <typename Same>
std::vector<Poses> runs(Poses poses, Same same) {
  std::vector<Poses> result;
  for (std::size_t first = 0; first < poses.size();) {
    std::size_t last = first + 1;
    while (last < poses.size() && same(poses[first], poses[last])) ++last;
    result.push_back(poses.subspan(first, last - first));
    first = last;
  }
  return result;
}

GridGeometry window_of(Poses poses, double cell_m, int reach) {
  LatticeIndex low = poses.front().cell;
  LatticeIndex high = low;
  for (const BinnedPose& pose : poses) {
    low = {std::min(low.col, pose.cell.col), std::min(low.row, pose.cell.row)};
    high = {std::max(high.col, pose.cell.col), std::max(high.row, pose.cell.row)};
  }
  return GridGeometry{cell_m, low, high.col - low.col + 1, high.row - low.row + 1}.padded(reach);
}

/// Matches poses of one heading, so many quarter turns to the right of the footprint's.
void match_on(const QuarterPlanes& planes, LatticeIndex origin, const PackedFootprint& footprint, int quarters,
              Poses poses, std::span<MatchSums> sums) {
  std::vector<PlaneCell> places;
  places.reserve(poses.size());
  for (const BinnedPose& pose : poses) {
    places.push_back(planes.place({pose.cell.col - origin.col, pose.cell.row - origin.row}, quarters));
  }
  std::vector<MatchSums> found(places.size());
  match_sums(planes.plane(quarters), footprint, places, found);
  for (std::size_t k = 0; k < poses.size(); ++k) sums[poses[k].index] = found[k];
}

}  // namespace

void match_binned(const MapView& map, const FeatureMap& features, const HeadingBins& bins,
                  std::vector<BinnedPose> poses, int threads, const std::stop_token& stop, std::span<MatchSums> sums) {
  assert(bins.count() % 4 == 0);
  const int quarter = bins.count() / 4;
  const int reach = footprint_reach(features);
  const FeatureRotator rotator(features);
  const auto same_heading = [](const BinnedPose& a, const BinnedPose& b) { return a.bin == b.bin; };
  put_in_order(poses, bins);
  for (const Poses block : runs(poses, [](const auto&a, const auto&b) { return block_of(a) == block_of(b); })) {
    const auto families = runs(block, [&](const auto& a, const auto& b) { return a.bin % quarter == b.bin % quarter; });
    const GridGeometry geometry = window_of(block, features.cell_m, reach);
    const auto spared = static_cast<double>(runs(block, same_heading).size() - families.size());
    const QuarterPlanes planes(map.read(geometry).cells, worth_rotating(geometry, reach, spared));
    parallel_for(static_cast<int>(families.size()), threads, [&](int task) {
      const Poses family = families[static_cast<std::size_t>(task)];
      FeatureMap turned = rotator.rotated(bins.heading(family.front().bin % quarter));
      PackedFootprint footprint(turned);
      int turns = 0;
      for (const Poses members : runs(family, same_heading)) {
        require_not_stopped(stop);
        const int quarters = members.front().bin / quarter;
        if (!planes.rotated() && turns < quarters) {
          for (; turns < quarters; ++turns) turned = quarter_turned(turned);
          footprint = PackedFootprint(turned);
        }
        match_on(planes, geometry.origin, footprint, quarters - turns, members, sums);
      }
    });
  }
}

}  // namespace roadfix
