// The second half of a proof: a closer look into blocks that may hold a better pose, by quarters and then cell by cell.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "core/match/footprint.hpp"
#include "core/proof/block_scan.hpp"

namespace roadfix {

class BlockVisit {
 public:
  /// `best`: what a pose has to exceed; may grow meanwhile.
  BlockVisit(const BoundProblem& problem, const std::atomic<double>& best) : problem_(problem), best_(best) {}

  /// The best pose of each node that has one above the best. All nodes are of this heading. Thread-safe.
  std::vector<LatticePose> best_poses(std::size_t heading, std::span<const BoundNode> nodes) const;

 private:
  /// Positions of a node that are left: side x side cells from (col, row) on.
  struct Part {
    std::size_t node = 0;
    int col = 0;
    int row = 0;
    BlockSums sums;
  };

  static std::vector<Part> parts_of(std::span<const BoundNode> nodes);
  static std::vector<Part> quarters(std::span<const Part> parts);
  std::vector<Part> surviving(std::vector<Part> parts, const PackedFootprint& above, int side) const;
  std::vector<LatticePose> best_of(std::size_t heading, const PackedFootprint& footprint,
                                   std::span<const Part> quarters) const;

  const BoundProblem& problem_;
  const std::atomic<double>& best_;
};

}  // namespace roadfix
