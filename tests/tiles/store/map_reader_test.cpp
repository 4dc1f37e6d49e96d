#include "tiles/store/map_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/grid/resample.hpp"
#include "core/units/error.hpp"
#include "core/units/parallel_for.hpp"
#include "tests/support/code_of.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

using testing::ingest;
using testing::random_cells;
using testing::settings_37n;
using testing::some_blocks;
using testing::TemporaryFolder;
using testing::TestSource;

class MapReaderTest : public ::testing::Test {
 protected:
  MapReaderTest() : path(folder / "m.gpkg"), writer(path, settings_37n()) { ingest(writer, source); }

  /// Cell of the map by its lattice index, from the source.
  Cell cell_at(int col, int row) const {
    const auto tile = tiles_covering({2.0, {col, row}, 1, 1}).front();
    if (!std::ranges::count(source.blocks, tile)) return kUnobserved;
    return random_cells(source.seed, tile).at(col - 256 * tile.col, row - 256 * tile.row);
  }

  TemporaryFolder folder;
  std::filesystem::path path;
  TestSource source{"a", 1, some_blocks(2)};
  MapWriter writer;
};

TEST_F(MapReaderTest, PastesAWindowOutOfSeveralTilesAndBeyondTheMap) {
  const MapReader reader(path);
  const GridGeometry window{2.0, {847 * 256 - 3, -8165 * 256 + 250}, 270, 12};
  const RoadGrid grid = reader.read(window);
  EXPECT_EQ(grid.geometry, window);
  for (const int row : {0, 5, 6, 11}) {
    for (const int col : {0, 2, 3, 4, 100, 258, 259, 269}) {
      EXPECT_EQ(grid.cells.at(col, row), cell_at(window.origin.col + col, window.origin.row + row));
    }
  }
}

TEST_F(MapReaderTest, TellsTheLargestRegistrationErrorOfTheSourcesThatObservedABox) {
  SourceRecord coarse = TestSource{"coarse", 2, {}}.record();
  coarse.provenance.registration_sigma_m = 40.0;
  const TileIndex beside{849, -8164};  // a tile to the east of the source's south-eastern one
  for (const TileIndex block : writer.begin_source(coarse, std::vector{beside}, false)) {
    testing::put_block(writer, coarse.name, block, random_cells(2, block));
  }
  const MapReader before(path);
  const GridBox own = tile_geometry(source.blocks.front(), 2.0).box();
  const GridBox south_east = tile_geometry({848, -8164}, 2.0).box();
  EXPECT_EQ(before.registration_sigma_m(grown(south_east, 10.0)), 2.5) << "not complete yet";
  writer.finish_source(coarse.name);
  const MapReader reader(path);
  EXPECT_EQ(reader.registration_sigma_m(grown(own, 10.0)), 2.5);
  EXPECT_EQ(reader.registration_sigma_m(grown(south_east, -10.0)), 2.5);
  EXPECT_EQ(reader.registration_sigma_m(grown(south_east, 10.0)), 40.0);
  EXPECT_EQ(reader.registration_sigma_m(grown(tile_geometry(beside, 2.0).box(), -10.0)), 40.0);
  EXPECT_EQ(reader.registration_sigma_m({{0.0, 0.0}, {10.0, 10.0}}), std::nullopt);
}

TEST_F(MapReaderTest, WindowsFarAwayAreUnobserved) {
  const MapReader reader(path);
  for (const LatticeIndex origin : {LatticeIndex{0, 0}, {-5000, -100}, {2'000'000'000, -2'000'000'000}}) {
    EXPECT_EQ(reader.read({2.0, origin, 5, 5}).cells, CellArray(5, 5));
  }
  EXPECT_EQ(reader.read({2.0, {0, 0}, 0, 0}).cells, CellArray());
}

TEST_F(MapReaderTest, CoarserCellsAreTheHalvedFinerOnes) {
  const MapReader reader(path);
  for (double cell_m = 4.0; cell_m <= 4096.0; cell_m *= 2) {
    const GridGeometry coarse = GridGeometry::covering(reader.info().extent, cell_m);
    const GridGeometry fine{
        cell_m / 2, {2 * coarse.origin.col, 2 * coarse.origin.row}, 2 * coarse.cols, 2 * coarse.rows};
    const RoadGrid grid = reader.read(coarse);
    EXPECT_EQ(grid.cells, halved(reader.read(fine).cells)) << cell_m;
    EXPECT_GT(grid.cells.observed_count(), 0U);
  }
}

TEST_F(MapReaderTest, OtherCellSizesAreRefused) {
  const MapReader reader(path);
  for (const double cell_m : {1.0, 3.0, 0.0, -2.0, 8192.0}) {
    EXPECT_THROW(reader.read({cell_m, {0, 0}, 4, 4}), InvalidInput) << cell_m;
  }
}

TEST_F(MapReaderTest, ListsItsTilesRowByRow) {
  EXPECT_EQ(MapReader(path).tiles(0), source.blocks);
  EXPECT_EQ(MapReader(path).tile(0, {0, -1}), std::nullopt);
}

TEST_F(MapReaderTest, KeepsNoMoreThanItsBoundInMemory) {
  for (const std::size_t bound : {std::size_t{0}, std::size_t{70'000}, std::size_t{200'000}}) {
    const MapReader reader(path, bound);
    for (int round = 0; round < 2; ++round) {
      for (const TileIndex tile : source.blocks) {
        EXPECT_EQ(reader.tile(0, tile), random_cells(source.seed, tile));
        EXPECT_LE(reader.cached_bytes(), bound);
      }
    }
  }
}

TEST_F(MapReaderTest, TheVersionTellsThatTheMapHasChanged) {
  const MapReader reader(path);
  EXPECT_EQ(MapReader(path).info().version, reader.info().version);
  ingest(writer, {"b", 2, some_blocks(1)});
  EXPECT_NE(MapReader(path).info().version, reader.info().version);
}

TEST_F(MapReaderTest, ReadsNothingThatAWriterHasChangedUntilTheMapIsAsItWas) {
  const MapReader reader(path);
  const TileIndex kept = source.blocks[0];
  const TileIndex other = source.blocks[3];
  const auto code_of_reading_other = [&] { return testing::code_of([&] { reader.tile(0, other); }); };
  reader.tile(0, kept);
  const TestSource next{"b", 2, some_blocks(1)};  // over the kept tile alone
  for (const TileIndex block : writer.begin_source(next.record(), next.blocks, false)) {
    testing::put_block(writer, next.name, block, random_cells(next.seed, block));
  }
  EXPECT_EQ(reader.tile(0, source.blocks[1]), random_cells(source.seed, source.blocks[1])) << "it is not fused yet";
  writer.finish_source(next.name);
  EXPECT_EQ(code_of_reading_other(), "map-renewed");
  EXPECT_EQ(testing::code_of([&] { reader.tiles(0); }), "map-renewed");
  EXPECT_EQ(reader.tile(0, kept), random_cells(source.seed, kept)) << "as it was when the map was opened";
  writer.remove_source(next.name);
  EXPECT_EQ(reader.tile(0, other), random_cells(source.seed, other));
  testing::open_sqlite(path).execute("INSERT INTO roadfix_pending VALUES (8, 0, 0)");
  EXPECT_EQ(testing::code_of([&] { reader.tile(1, {0, -1}); }), "map-renewed") << "overviews that wait to be made anew";
}

TEST_F(MapReaderTest, ReadsNothingOfAMapThatIsCopiedIntoTheFile) {
  namespace fs = std::filesystem;
  const fs::path other = folder / "other.gpkg";
  fs::copy_file(path, other);
  testing::open_sqlite(other).execute("UPDATE roadfix_meta SET value = '0123456789abcdef' WHERE key = 'version'");
  {  // written to as often and as long as the other, by which SQLite tells whether its pages in memory still hold
    std::array<char, 100> header{};
    std::ifstream(path).read(header.data(), header.size());
    std::fstream(other, std::ios::in | std::ios::out).write(header.data(), header.size());
  }
  const MapReader reader(path, 0);
  for (const TileIndex block : source.blocks) EXPECT_EQ(reader.tile(0, block), random_cells(source.seed, block));
  fs::copy_file(other, path, fs::copy_options::overwrite_existing);
  for (const TileIndex block : source.blocks) {
    EXPECT_EQ(testing::code_of([&] { reader.tile(0, block); }), "map-renewed");
  }
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_EQ(testing::code_of([&] { reader.tile(0, source.blocks[0]); }), "map-cut-off") << "while it is copied";
}

TEST_F(MapReaderTest, ReadsOnInAFileThatWasOnlyTouched) {
  const MapReader reader(path, 0);
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now());
  EXPECT_EQ(reader.tile(0, source.blocks[0]), random_cells(source.seed, source.blocks[0]));
}

TEST_F(MapReaderTest, ManyThreadsReadOneVersionWhileAWriterWritesAnother) {
  const MapReader reader(path, 100'000);
  const GridGeometry coarse{4.0, {847 * 128, -8165 * 128}, 300, 300};
  const RoadGrid before = reader.read(coarse);
  std::atomic<bool> go_on = true;
  std::atomic<int> refused = 0;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      while (go_on) {
        try {
          EXPECT_EQ(reader.tile(0, source.blocks[0]), random_cells(source.seed, source.blocks[0]));
          EXPECT_EQ(reader.read(coarse).cells, before.cells);
        } catch (const InUse& error) {
          EXPECT_EQ(error.code(), "map-renewed");
          ++refused;
        }
      }
    });
  }
  ingest(writer, {"b", 2, some_blocks(3, 1)});  // over one of the tiles, and beside them
  while (refused < 20) std::this_thread::yield();
  go_on = false;
}

TEST_F(MapReaderTest, NeverReadsAnotherFileThatTookItsPlace) {
  const MapReader reader(path, 0);
  {
    MapWriter other(folder / "other.gpkg", settings_37n());
    ingest(other, {"a", 3, source.blocks});
  }
  std::filesystem::rename(folder / "other.gpkg", path);
  const CellArray expected = random_cells(source.seed, source.blocks[0]);
  std::atomic<int> others = 0;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) {
        try {
          if (reader.tile(0, source.blocks[0]) != expected) ++others;
        } catch (const InUse&) {  // of those that need a descriptor of their own
        }
      }
    });
  }
  threads.clear();
  EXPECT_EQ(others, 0);
  EXPECT_EQ(reader.tile(0, source.blocks[0]), expected);
}

TEST_F(MapReaderTest, ClosesWhatManyThreadsAtOnceHaveOpened) {
  const auto map = folder / "other.gpkg";
  {
    MapWriter other(map, settings_37n());
    ingest(other, source);
  }
  const MapReader reader(map, 0);
  const int most = std::max(4, processors());
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4 * most; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i) reader.tile(0, source.blocks[0]);
    });
  }
  threads.clear();
  const auto opened =
      std::ranges::count_if(std::filesystem::directory_iterator("/proc/self/fd"), [&](const auto& descriptor) {
        std::error_code gone;
        return std::filesystem::read_symlink(descriptor, gone) == map;
      });
  EXPECT_LE(opened, most);
}

}  // namespace
}  // namespace roadfix
