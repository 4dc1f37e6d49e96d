// The second half of a proof: blocks that may hold a better pose are bounded by quarters, then scored cell by cell.
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "core/match/footprint.hpp"
#include "core/proof/block_scan.hpp"

namespace roadfix {

class BlockVisit {
 public:
  /// `floor`: the score that a pose has to exceed; may grow meanwhile.
  BlockVisit(const BoundProblem& problem, const std::atomic<double>& floor) : problem_(problem), floor_(floor) {}

  /// The best pose of these nodes, by is_better(), if it exceeds the floor. All nodes have this heading. Thread-safe.
  std::optional<LatticePose> best_pose(std::size_t heading, std::span<const BoundNode> nodes) const;

 private:
  /// Positions that are left: side x side cells from (col, row) on.
  struct Part {
    int col = 0;
    int row = 0;
    BlockSums sums;
  };

  static std::vector<Part> parts_of(std::span<const BoundNode> nodes);
  static std::vector<Part> quarters(std::span<const Part> parts);
  std::vector<Part> surviving(std::vector<Part> parts, const PackedFootprint& above, int side) const;
  std::optional<LatticePose> best_of(std::size_t heading, const PackedFootprint& footprint,
                                     std::span<const Part> quarters) const;

  const BoundProblem& problem_;
  const std::atomic<double>& floor_;
};

}  // namespace roadfix
