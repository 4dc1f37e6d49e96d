#include "tiles/pipeline/witnesses.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/grid/resample.hpp"
#include "tests/support/put_block.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kTownCellM = 2.0;

/// A tile of the town, which lies so many cells too far east.
CellArray town(int east = 0, std::uint64_t seed = 5) {
  constexpr int kRim = 20;
  const CellArray all =
      testing::street_map(seed, {kTownCellM, {0, 0}, kTileCells + 2 * kRim, kTileCells + 2 * kRim}).cells;
  CellArray cells(kTileCells, kTileCells);
  paste(all, cells, east - kRim, -kRim);
  return cells;
}

/// Its roads, one cell wider on either side.
CellArray widened(const CellArray& cells) {
  CellArray result = cells;
  for (const auto& [east, south] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    for (int row = std::max(0, -south); row < kTileCells - std::max(0, south); ++row) {
      for (int col = std::max(0, -east); col < kTileCells - std::max(0, east); ++col) {
        Cell& here = result.at(col + east, row + south);
        here = std::max(here, cells.at(col, row));
      }
    }
  }
  return result;
}

/// Without the roads of so many columns of ten.
CellArray without(CellArray cells, int columns) {
  for (int row = 0; row < kTileCells; ++row) {
    for (int col = 0; col < kTileCells; ++col) {
      if (col / 8 % 10 < columns) cells.at(col, row) = kNoRoad;
    }
  }
  return cells;
}

SharedEvidence shared(CellArray own, CellArray others) {
  SharedEvidence result;
  result.tiles.push_back({std::move(own), std::move(others)});
  return result;
}

TEST(Copy, IsWhatSaysTheSameInEveryCell) { EXPECT_TRUE(is_copy(shared(town(), town()))); }

TEST(Copy, IsWhatLacksRoadsOfTheOtherOrHasMore) {
  EXPECT_TRUE(is_copy(shared(without(town(), 1), town())));
  EXPECT_TRUE(is_copy(shared(town(), without(town(), 1))));
  EXPECT_TRUE(is_copy(shared(town(), without(town(), 6)))) << "as of the larger roads alone";
}

TEST(Copy, IsWhatDrawsTheSameRoadsWider) {
  EXPECT_TRUE(is_copy(shared(town(), widened(town()))));
  EXPECT_TRUE(is_copy(shared(without(widened(town()), 1), town())));
}

TEST(Copy, IsWhatIsNeverQuiteAsSureOfTheSameRoads) {
  CellArray doubted = town();
  for (Cell& cell : doubted.cells()) cell = static_cast<Cell>(20 + cell / 2);
  EXPECT_TRUE(is_copy(shared(town(), doubted)));
}

TEST(Copy, IsWhatDoubtsTheSameRoadsElsewhere) {
  // As of one image, read by two networks.
  CellArray one = town();
  CellArray other = town();
  for (int row = 0; row < kTileCells; ++row) {
    for (int col = 0; col < kTileCells; ++col) {
      Cell& doubted = row / 4 % 2 == 0 ? one.at(col, row) : other.at(col, row);
      if (col / 4 % 2 == 0) doubted = static_cast<Cell>(doubted / 2);
    }
  }
  EXPECT_TRUE(is_copy(shared(one, other)));
}

TEST(Copy, IsWhatSaysTheSameWhereverItSaysAnything) {
  CellArray part = town();
  for (int row = 0; row < kTileCells; ++row) std::fill_n(part.row(row).begin(), 200, kUnobserved);
  EXPECT_TRUE(is_copy(shared(part, town())));
}

TEST(Copy, IsNoneOfRoadsThatLieTwoCellsAside) {
  EXPECT_FALSE(is_copy(shared(town(2), town())));
  EXPECT_FALSE(is_copy(shared(without(town(2), 3), town())));
}

TEST(Copy, IsNoneWhereBothHardlyDoubtThatThereIsNoRoad) {
  CellArray faint = town();
  for (Cell& cell : faint.cells()) cell = static_cast<Cell>(5 + cell / 64);
  EXPECT_FALSE(is_copy(shared(CellArray(kTileCells, kTileCells, 5), faint)));
}

TEST(Copy, IsNoneOfAnotherTownNorOfWhatShowsNoRoads) {
  EXPECT_FALSE(is_copy(shared(town(0, 6), town())));
  EXPECT_FALSE(is_copy(shared(CellArray(kTileCells, kTileCells, kNoRoad), town())));
  EXPECT_FALSE(is_copy(shared(CellArray(kTileCells, kTileCells, kRoad), town()))) << "everything is a road";
  EXPECT_FALSE(is_copy({}));
}

class SeveralSources : public ::testing::Test {
 protected:
  void put(const std::string& name, const CellArray& cells) {
    const SourceRecord record{.name = name, .content = SourceContent::kRoads, .fingerprint = name};
    const std::vector<TileIndex> blocks{{847, -8165}};
    writer.begin_source(record, blocks, false);
    testing::put_block(writer, name, blocks[0], cells);
    writer.finish_source(name);
  }

  testing::TemporaryFolder folder;
  MapWriter writer{folder / "m.gpkg", {*UtmZone::from_epsg(32637), kTownCellM}};
};

TEST_F(SeveralSources, AreAsManyWitnessesAsThereAreSourcesThatAreNoCopies) {
  put("a", town());
  put("b", town(2));
  put("copy of a", town());
  put("copy of b", town(2));
  put("d", town(4));
  const auto [copies, others] = Witnesses(writer).around("a");
  EXPECT_THAT(copies, ElementsAre("copy of a"));
  EXPECT_THAT(others, ::testing::UnorderedElementsAre(ElementsAre("b", "copy of b"), ElementsAre("d")));
  EXPECT_THAT(Witnesses(writer).around("d").copies, IsEmpty());
  EXPECT_EQ(Witnesses(writer).around("d").others.size(), 2U);
}

TEST_F(SeveralSources, AreOneWitnessIfWhatOneWasMadeOfIsACopyOfBoth) {
  put("east", without(town(), 5));
  CellArray rest = town();
  for (int row = 0; row < kTileCells; ++row) {
    for (int col = 0; col < kTileCells; ++col) {
      if (col / 8 % 10 >= 5) rest.at(col, row) = kNoRoad;
    }
  }
  put("west", rest);
  EXPECT_THAT(Witnesses(writer).around("east").copies, IsEmpty());
  put("whole", town());
  EXPECT_THAT(Witnesses(writer).around("east").copies, ElementsAre("west", "whole"));
}

}  // namespace
}  // namespace roadfix
