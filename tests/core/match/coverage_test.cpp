#include "core/match/coverage.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <utility>

#include "tests/support/random_cells.hpp"

namespace roadfix {
namespace {

using Cells = std::set<std::pair<int, int>>;  ///< (row, col) from the nadir's cell

Cells cells_of(const Footprint& footprint) {
  Cells cells;
  for (const Footprint::Span& span : footprint.spans()) {
    for (int i = 0; i < span.cells; ++i) {
      if (footprint.mask()[span.offset + static_cast<std::size_t>(i)] == 0) continue;
      EXPECT_TRUE(cells.insert({span.row, span.first_col + i}).second) << "a cell is in two spans";
    }
  }
  return cells;
}

Cells moved(const Cells& cells, int cols, int rows) {
  Cells result;
  for (const auto& [row, col] : cells) result.insert({row + rows, col + cols});
  return result;
}

TEST(Coverage, HoldsWhatIsSeenFromEveryPositionAndApartWhatIsSeenFromSome) {
  std::mt19937_64 random(3);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const FeatureMap features =
        FeatureMap::centred(testing::random_cells(random, 1 + below(90), 1 + below(30), 0.02 * below(8)), 1.0);
    const int side = 1 + round % 4;
    const Cells seen = cells_of(Footprint(features));
    Cells always = seen;
    Cells ever;
    for (int k = 0; k < side * side; ++k) {
      const Cells from_here = moved(seen, k % side, k / side);
      std::erase_if(always, [&](const auto& cell) { return !from_here.contains(cell); });
      ever.insert(from_here.begin(), from_here.end());
    }
    const Coverage coverage = Coverage::of(features, side);
    EXPECT_EQ(cells_of(coverage.always), always);
    Cells all = cells_of(coverage.sometimes);
    for (const auto& cell : always) EXPECT_TRUE(all.insert(cell).second) << "seen always and sometimes";
    EXPECT_EQ(all, ever);
  }
}

}  // namespace
}  // namespace roadfix
