// The first half of a proof: an upper bound for every block of positions at every heading. Blocks that could hold a
// better pose than the best one known become nodes, to be visited.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "core/proof/heading_sectors.hpp"

namespace roadfix {

/// A block of positions at a heading that may hold a better pose.
struct BoundNode {
  std::int32_t col = 0;  ///< block of the map
  std::int32_t row = 0;
  std::int32_t heading = 0;  ///< index into the headings searched
  float bound = 0.0F;
  BlockSums sums;  ///< from which `bound` follows
};

/// Blocks that are bounded together: BoundMap::kRun columns and so many rows.
struct BlockTile {
  int col = 0;
  int row = 0;
  int rows = 0;
};

struct BlockScanResult {
  std::vector<BoundNode> nodes;
  std::int64_t eligible = 0;  ///< blocks with an eligible position, times headings
  bool complete = true;       ///< false if time ran out
};

class BlockScan {
 public:
  /// `floor`: the score that a pose has to exceed; may grow while the scan runs.
  BlockScan(const BoundProblem& problem, const HeadingSectors& headings, const std::atomic<double>& floor)
      : problem_(problem), headings_(headings), floor_(floor) {}

  std::vector<BlockTile> tiles() const;
  /// As in BlockScanResult.
  std::int64_t eligible(const BlockTile& tile) const { return eligible(rows_of(tile)); }
  /// Thread-safe.
  BlockScanResult scan(const BlockTile& tile, const Deadline& deadline) const;

 private:
  template <typename T>
  using PerBlock = std::array<T, BoundMap::kRun>;
  struct Row {
    SectorRun run;
    PerBlock<double> needed{};  ///< of the cross sum, for a score above the floor
    PerBlock<bool> eligible{};
    bool excluded = true;  ///< in every block
  };

  std::vector<Row> rows_of(const BlockTile& tile) const;
  std::int64_t eligible(const std::vector<Row>& rows) const;
  void cover(const Sector& sector, const BlockTile& tile, std::vector<Row>& rows) const;
  /// Exact sums below a tile, and how many of the blocks tried with them they excluded so far.
  struct Ground {
    GroundSums sums;
    int tried = 0;
    int excluded = 0;
    bool is_worth_its_time() const;
  };

  GroundSums ground_below(const BlockTile& tile) const;
  void scan_row(std::size_t heading, int col, int row, const Row& known, Ground& ground,
                std::vector<BoundNode>& nodes) const;

  const BoundProblem& problem_;
  const HeadingSectors& headings_;
  const std::atomic<double>& floor_;
};

}  // namespace roadfix
