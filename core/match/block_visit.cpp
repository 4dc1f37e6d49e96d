#include "core/match/block_visit.hpp"

#include <algorithm>
#include <map>

#include "core/match/kernel.hpp"
#include "core/match/score.hpp"

namespace roadfix {
namespace {

constexpr int kQuarterCells = kBlockCells / 2;  // along an edge

}  // namespace

std::vector<LatticePose> BlockVisit::best_poses(std::size_t heading, std::span<const BoundNode> nodes) const {
  const FeatureMap turned = problem_.rotator.rotated(problem_.heading(heading));
  const PackedFootprint above(above_base(turned, problem_.base));
  std::vector<Part> parts = parts_of(heading, nodes);
  parts = surviving(std::move(parts), above, kBlockCells);
  parts = surviving(quarters(parts), above, kQuarterCells);
  return best_of(heading, PackedFootprint(turned), parts);
}

std::vector<BlockVisit::Part> BlockVisit::parts_of(std::size_t heading, std::span<const BoundNode> nodes) const {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    parts.push_back({i, kBlockCells * nodes[i].col, kBlockCells * nodes[i].row, sums_at(heading, nodes[i])});
  }
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
    if (score_bound(part.sums, problem_.full_cells, problem_.search.min_cells) > best_) result.push_back(part);
  }
  return result;
}

/// What is known of a block without its cross sum.
BlockSums BlockVisit::sums_at(std::size_t heading, const BoundNode& node) const {
  const Sector& sector = headings_.sector_of(heading);
  const TurnedFeatures& turned = headings_.turned(heading);
  if (node.map_observed) {
    BlockSums sums = sector.features;
    sums.map = {static_cast<double>(node.map_min), static_cast<double>(node.map_max)};
    sums.map_square = {static_cast<double>(node.square_min), static_cast<double>(node.square_max)};
    narrow(sums, turned);
    return sums;
  }
  SectorRun run;
  covered_sums(problem_.map, sector.inner, node.col, node.row, run.inner);
  covered_sums(problem_.map, sector.outer, node.col, node.row, run.outer);
  BlockSums sums = HeadingSectors::covered(sector, run, 0).sums;
  const auto at = [&](const BoundTerms& terms) {
    RunSums values;
    term_sums(problem_.map, terms, node.col, node.row, values);
    return values[0] * terms.unit;
  };
  narrow(sums, turned, {at(turned.sum_min), at(turned.sum_max), at(turned.square_min)});
  return sums;
}

std::vector<LatticePose> BlockVisit::best_of(std::size_t heading, const PackedFootprint& footprint,
                                             std::span<const Part> quarters) const {
  std::vector<PlaneCell> places;
  std::vector<std::size_t> owners;
  for (const Part& part : quarters) {
    for (int i = 0; i < kQuarterCells * kQuarterCells; ++i) {
      const PlaneCell place{part.col + i % kQuarterCells, part.row + i / kQuarterCells};
      if (!problem_.cell_eligible(place.col, place.row)) continue;
      places.push_back(place);
      owners.push_back(part.node);
    }
  }
  std::vector<MatchSums> sums(places.size());
  match_sums(problem_.map.exact(), footprint, places, sums);
  const auto full_cells = static_cast<std::int64_t>(problem_.full_cells);
  const LatticeIndex origin = problem_.map.geometry().origin;
  std::map<std::size_t, LatticePose> best;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double score = score_of(sums[i], full_cells, problem_.search.min_cells);
    if (score <= 0.0) continue;
    LatticePose& pose = best[owners[i]];
    if (score <= pose.score) continue;
    pose = {{origin.col + places[i].col, origin.row + places[i].row}, problem_.search.headings[heading], score};
  }
  std::vector<LatticePose> poses;
  for (const auto& [node, pose] : best) {
    if (pose.score > best_) poses.push_back(pose);
  }
  return poses;
}

}  // namespace roadfix
