#include "core/search/score_spread.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>

#include "core/search/search_scan.hpp"
#include "tests/core/search/seen_town.hpp"

namespace roadfix {
namespace {

const Deadline kNoDeadline;

struct Question : testing::SeenTown {
  Question(std::uint64_t seed, int cells, int map_cells = 800)
      : SeenTown(seed, map_cells, map_cells - 100, 300.0, cells, cells) {}

  SearchResult answer() const { return search(read, 2.0, seen, region, {}); }
};

// 256 places give the root of a mean square to 1 / sqrt(2 * 256) = 4.4 % (1 sigma), if all headings of a place counted
// as one; the means below a scanned footprint are those of a coarser grid.
constexpr double kTolerance = 0.15;

TEST(ScoreSpread, IsThatOfAllPosesOfTheRegion) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Question question(seed, 150);
    const SearchLevels levels = question.levels();
    ASSERT_EQ(levels.coarse().cell_m(), 8.0);
    const double scanned = question.answer().background.sd;
    const auto sampled = score_spread(levels.coarse(), question.region, kNoDeadline);
    ASSERT_TRUE(sampled);
    EXPECT_NEAR(*sampled, scanned, kTolerance * scanned) << seed;
  }
}

TEST(ScoreSpread, IsThatOfAllPosesAlsoOfARegionOfWhichOnlyTheGroundBelowTheSampleIsRead) {
  Question question(1, 40, 1400);
  const double scanned = SearchScan(question.levels(), {}).run().sd;
  std::size_t windows = 0;
  question.read = [&, read = question.read](const GridGeometry& window) {
    ++windows;
    return read(window);
  };
  const auto sampled = score_spread(question.levels().coarse(), question.region, kNoDeadline);
  EXPECT_EQ(windows, 256U);
  EXPECT_NEAR(sampled.value(), scanned, kTolerance * scanned);
}

TEST(ScoreSpread, IsNotToldWhereTimeRanOut) {
  const Question question(1, 150);
  const Deadline over({}, std::chrono::steady_clock::now());
  EXPECT_EQ(score_spread(question.levels().coarse(), question.region, over), std::nullopt);
}

TEST(ScoreSpread, IsToldInCellsOf8MetresWhereTheScanHasCoarserOnes) {
  const Question question(4, 250);
  const SearchLevels levels = question.levels();
  ASSERT_EQ(levels.coarse().cell_m(), 16.0);
  const Level& finer = levels.at(levels.spread_level());
  EXPECT_EQ(finer.cell_m(), 8.0);
  EXPECT_EQ(question.answer().background.sd, score_spread(finer, question.region, kNoDeadline));
  EXPECT_LT(*score_spread(finer, question.region, kNoDeadline),
            *score_spread(levels.coarse(), question.region, kNoDeadline));
}

TEST(ScoreSpread, IsNotToldOfAMapWithoutObservedGround) {
  Question question(5, 150);
  const RoadGrid empty = RoadGrid::unobserved(question.map.geometry);
  question.read = testing::reader_of(empty);
  EXPECT_EQ(score_spread(question.levels().coarse(), question.region, kNoDeadline), std::nullopt);
}

}  // namespace
}  // namespace roadfix
