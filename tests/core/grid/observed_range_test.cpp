#include "core/grid/observed_range.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace roadfix {
namespace {

TEST(ObservedIn, IsFromTheFirstObservedCellToTheLast) {
  const auto range = observed_in(std::vector<Cell>{kUnobserved, 0, kUnobserved, 7, kUnobserved, kUnobserved});
  ASSERT_TRUE(range);
  EXPECT_EQ(range->first, 1);
  EXPECT_EQ(range->end, 4);
}

TEST(ObservedIn, IsNothingWhereNoCellIsObserved) {
  EXPECT_FALSE(observed_in(std::vector<Cell>{kUnobserved, kUnobserved}));
  EXPECT_FALSE(observed_in({}));
}

}  // namespace
}  // namespace roadfix
