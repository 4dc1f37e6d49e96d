#include "core/proof/block_visit.hpp"

#include "core/match/kernel.hpp"
#include "core/match/score.hpp"

namespace roadfix {
namespace {

constexpr int kQuarterCells = kBlockCells / 2;  // along an edge

}  // namespace

std::optional<LatticePose> BlockVisit::best_pose(std::size_t heading, std::span<const BoundNode> nodes) const {
  const FeatureMap turned = problem_.rotator.rotated(problem_.heading(heading));
  const PackedFootprint above(above_base(turned, problem_.base));
  std::vector<Part> parts = parts_of(nodes);
  parts = surviving(std::move(parts), above, kBlockCells);
  parts = surviving(quarters(parts), above, kQuarterCells);
  return best_of(heading, PackedFootprint(turned), parts);
}

std::vector<BlockVisit::Part> BlockVisit::parts_of(std::span<const BoundNode> nodes) {
  std::vector<Part> parts;
  for (const BoundNode& node : nodes) parts.push_back({kBlockCells * node.col, kBlockCells * node.row, node.sums});
  return parts;
}

std::vector<BlockVisit::Part> BlockVisit::quarters(std::span<const Part> parts) {
  std::vector<Part> result;
  for (const Part& part : parts) {
    for (int i = 0; i < 4; ++i) {
      Part quarter = part;
      quarter.col += kQuarterCells * (i % 2);
      quarter.row += kQuarterCells * (i / 2);
      result.push_back(quarter);
    }
  }
  return result;
}

std::vector<BlockVisit::Part> BlockVisit::surviving(std::vector<Part> parts, const PackedFootprint& above,
                                                    int side) const {
  std::vector<PlaneCell> places;
  for (const Part& part : parts) places.push_back({part.col, part.row});
  std::vector<std::int64_t> products(places.size());
  product_sums(problem_.map.pooled(side), above, places, products);
  std::vector<Part> result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Part& part = parts[i];
    part.sums.cross_max = static_cast<double>(products[i]);
    if (problem_.bound_of(part.sums) > floor_) result.push_back(part);
  }
  return result;
}

std::optional<LatticePose> BlockVisit::best_of(std::size_t heading, const PackedFootprint& footprint,
                                               std::span<const Part> quarters) const {
  std::vector<PlaneCell> places;
  for (const Part& part : quarters) {
    for (int i = 0; i < kQuarterCells * kQuarterCells; ++i) {
      const PlaneCell place{part.col + i % kQuarterCells, part.row + i / kQuarterCells};
      if (problem_.cell_eligible(place.col, place.row)) places.push_back(place);
    }
  }
  std::vector<MatchSums> sums(places.size());
  match_sums(problem_.map.exact(), footprint, places, sums);
  const LatticeIndex origin = problem_.map.geometry().origin;
  std::optional<LatticePose> best;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const LatticePose pose{{origin.col + places[i].col, origin.row + places[i].row},
                           problem_.search.headings[heading],
                           score_of(sums[i], problem_.search.cells)};
    if (pose.score > floor_ && (!best || is_better(pose, *best))) best = pose;
  }
  return best;
}

}  // namespace roadfix
