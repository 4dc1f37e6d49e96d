// What is added up for a bound, against plain loops: a piece of road that is missed only here and there hides behind
// how loose bounds are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/match/footprint.hpp"
#include "core/proof/bound_map.hpp"
#include "core/proof/bound_sums.hpp"
#include "core/proof/turned_features.hpp"
#include "tests/support/random_cells.hpp"

namespace roadfix {
namespace {

constexpr int kSide = 68;  // of the map, cells: no whole number of runs of blocks

/// A feature map at one heading above every block of a map from which it stays within it.
class BlockBounds {
 public:
  explicit BlockBounds(std::uint64_t seed)
      : random_(seed),
        ground_{{4.0, {0, 0}, kSide, kSide}, with_holes(testing::smooth_cells(random_, kSide, kSide))},
        map_(ground_),
        features_(FeatureMap::centred(with_holes(testing::smooth_cells(random_, 19, 14)), 4.0)),
        base_(base_of(features_)),
        heading_(Angle::degrees(37.0 * static_cast<double>(seed))),
        turned_(rotated(features_, heading_)),
        bounds_(turned_, heading_, base_, find_lines(features_, base_), map_) {}

  template <typename Visit>
  void for_each_block(const Visit& visit) const {
    const int margin = (footprint_reach(features_) + kBlockCells - 1) / kBlockCells;
    for (int row = margin; row < kSide / kBlockCells - margin; ++row) {
      for (int col = margin; col < kSide / kBlockCells - margin; ++col) {
        SCOPED_TRACE(::testing::Message() << "block " << col << ' ' << row);
        visit(col, row);
      }
    }
  }

  struct Sums {
    double cross = 0.0, feature = 0.0, feature_square = 0.0;
  };
  /// Of each position of a block.
  std::vector<Sums> counted(int block_col, int block_row) const {
    std::vector<Sums> all;
    for (int position = 0; position < kBlockCells * kBlockCells; ++position) {
      const int left = kBlockCells * block_col + position % kBlockCells - static_cast<int>(turned_.nadir.col);
      const int top = kBlockCells * block_row + position / kBlockCells - static_cast<int>(turned_.nadir.row);
      Sums& sums = all.emplace_back();
      for (int row = 0; row < turned_.cells.rows(); ++row) {
        for (int col = 0; col < turned_.cells.cols(); ++col) {
          const Cell seen = turned_.cells.at(col, row);
          const Cell below = ground_.cells.get(left + col, top + row);
          if (!is_observed(seen) || !is_observed(below)) continue;
          sums.cross += std::max(0, seen - base_) * (below - map_.base());
          sums.feature += seen;
          sums.feature_square += double{1} * seen * seen;
        }
      }
    }
    return all;
  }

  double bound(const BoundTerms& terms, int block_col, int block_row) const {
    RunSums sums{};
    term_sums(map_, terms, block_col, block_row, sums);
    return sums.front() * terms.unit;
  }

  const RoadGrid& ground() const { return ground_; }
  const BoundMap& map() const { return map_; }
  const TurnedFeatures& bounds() const { return bounds_; }

 private:
  CellArray with_holes(CellArray cells) {
    for (int hole = 0; hole < 3; ++hole) {
      const auto at = [&](int size) { return static_cast<int>(random_() % static_cast<std::uint64_t>(size)); };
      const int col = at(cells.cols());
      paste(CellArray(6, 3), cells, col, at(cells.rows()));
    }
    return cells;
  }

  std::mt19937_64 random_;
  RoadGrid ground_;
  BoundMap map_;
  FeatureMap features_;
  int base_;
  Angle heading_;
  FeatureMap turned_;
  TurnedFeatures bounds_;
};

TEST(BlockBounds, HoldForTheRoadAndTheFeaturesAtEveryPositionOfABlock) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const BlockBounds given(seed);
    const TurnedFeatures& bounds = given.bounds();
    given.for_each_block([&](int col, int row) {
      const double cross = given.bound(bounds.cross, col, row);
      const double least = given.bound(bounds.sum_min, col, row);
      const double most = given.bound(bounds.sum_max, col, row);
      const double square = given.bound(bounds.square_min, col, row);
      for (const BlockBounds::Sums& sums : given.counted(col, row)) {
        EXPECT_GE(cross, sums.cross);
        EXPECT_LE(least, sums.feature);
        EXPECT_GE(most, sums.feature);
        EXPECT_LE(square, sums.feature_square);
      }
    });
  }
}

TEST(BlockBounds, OfAPieceAreTheMostThatItMatchesRoundedUp) {
  const BlockBounds given(1);
  const BoundMap& map = given.map();
  for (const int direction : {0, 5, 16, 27, BoundMap::kCellPlane}) {
    const std::vector<CellOffset> piece =
        direction == BoundMap::kCellPlane ? std::vector<CellOffset>{{0, 0}} : line_stencil(direction);
    given.for_each_block([&](int block_col, int block_row) {
      int best = 0;
      for (int place = 0; place < kBlockWindow * kBlockWindow; ++place) {
        int sum = 0;
        for (const CellOffset cell : piece) {
          const Cell below = given.ground().cells.get(kBlockCells * block_col + place % kBlockWindow + cell.col,
                                                      kBlockCells * block_row + place / kBlockWindow + cell.row);
          sum += is_observed(below) ? below - map.base() : 0;
        }
        best = std::max(best, sum);
      }
      const double whole = static_cast<double>(piece.size()) * map.span();
      EXPECT_EQ(*map.plane(direction, block_col, block_row), std::ceil(BoundMap::kFull * best / whole)) << direction;
    });
  }
}

TEST(BlockBounds, OfTheGroundBelowAreTheSumsOfItsBlocks) {
  const BlockBounds given(2);
  const std::vector<RowRun> runs{{-2, -1, 3}, {0, -3, 0}, {0, 1, 2}};
  given.for_each_block([&](int block_col, int block_row) {
    std::uint32_t cells = 0;
    std::uint32_t value = 0;
    std::uint32_t square = 0;
    for (const RowRun& run : runs) {
      for (int i = 0; i < kBlockCells * kBlockCells * (run.end - run.first); ++i) {
        const int col = kBlockCells * (block_col + run.first) + i / kBlockCells;
        const int row = kBlockCells * (block_row + run.row) + i % kBlockCells;
        const Cell cell = given.ground().cells.get(col, row);
        if (!is_observed(cell)) continue;
        const auto above = static_cast<std::uint32_t>(cell - given.map().base());
        cells += 1;
        value += above;
        square += above * above;
      }
    }
    CoveredSums sums;
    covered_sums(given.map(), runs, block_col, block_row, sums);
    EXPECT_EQ(sums.cells.front(), cells);
    EXPECT_EQ(sums.value.front(), value);
    EXPECT_EQ(sums.square.front(), square);
  });
}

}  // namespace
}  // namespace roadfix
