#include "core/grid/cell_array.hpp"

#include <gtest/gtest.h>

#include "tests/support/ascii_map.hpp"

namespace roadfix {
namespace {

using testing::from_ascii;
using testing::to_ascii;

TEST(Cell, ProbabilitySurvivesTheRoundTrip) {
  for (int k = 0; k <= 254; ++k) EXPECT_EQ(cell_from_probability(probability(static_cast<Cell>(k))), k);
}

TEST(CellArray, PasteClipsOnAllSides) {
  const CellArray stamp = from_ascii("## ## ##");
  for (int col = -3; col <= 4; ++col) {
    for (int row = -4; row <= 4; ++row) {
      CellArray target = from_ascii(".... .... ....");
      paste(stamp, target, col, row);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
          EXPECT_EQ(target.at(c, r) == kRoad, stamp.contains(c - col, r - row)) << to_ascii(target);
      }
    }
  }
}

TEST(CellArray, CountsWhatWasObserved) { EXPECT_EQ(from_ascii("?#. ??5").observed_count(), 3u); }

}  // namespace
}  // namespace roadfix
