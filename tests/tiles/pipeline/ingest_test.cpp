#include "tiles/pipeline/ingest.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix {
namespace {

const MapSettings kSettings{*UtmZone::from_epsg(32637), 2.0};

/// Noise that depends on the block's place and seed alone, in a box that begins and ends inside of tiles.
class NoiseSource final : public CellSource {
 public:
  SourceSummary summary() const override { return {}; }
  GridBox extent() const override { return extent_; }
  bool touches(const GridBox& box) const override {
    return box.max.east_m > extent().min.east_m && box.min.east_m < extent().max.east_m &&
           box.max.north_m > extent().min.north_m && box.min.north_m < extent().max.north_m;
  }
  CellArray read(const GridGeometry& block, std::uint64_t seed) const override {
    const std::int64_t reads = ++reads_;
    if (reads == fail_at_) throw CorruptData("image-unreadable-block", "a.tif: damaged");
    if (reads == stop_at_) stop_.request_stop();
    std::this_thread::sleep_for(time_);
    std::mt19937_64 random(seed);
    CellArray cells(block.cols, block.rows);
    for (int row = 0; row < block.rows; ++row) {
      for (int col = 0; col < block.cols; ++col) {
        const auto value = static_cast<Cell>(random() % 255U);
        if (extent().contains(block.cell_center(col, row))) cells.at(col, row) = value;
      }
    }
    return cells;
  }
  void set_extent(GridBox extent) { extent_ = extent; }
  void take(std::chrono::milliseconds time) { time_ = time; }
  void fail_at(std::int64_t read) { fail_at_ = read; }
  void stop_at(std::int64_t read) { stop_at_ = read; }
  std::stop_token stop() { return stop_.get_token(); }
  std::int64_t reads() const { return reads_; }

 private:
  GridBox extent_{{400100.0, 4200100.0}, {402900.0, 4202300.0}};
  std::chrono::milliseconds time_{0};  ///< for each block
  mutable std::atomic<std::int64_t> reads_ = 0;
  std::int64_t fail_at_ = -1;
  std::int64_t stop_at_ = -1;
  mutable std::stop_source stop_;
};

SourceRecord record() {
  SourceRecord result;
  result.name = "noise";
  result.content = SourceContent::kImagery;
  result.fingerprint = "1";
  return result;
}

class IngestTest : public ::testing::Test {
 protected:
  IngestReport run(const CellSource& source, const std::string& map, int jobs, std::stop_token stop = {}) {
    MapWriter writer(folder / map, kSettings);
    return ingest(source, record(), writer, {.jobs = jobs, .seed = 5, .stop = std::move(stop)});
  }
  /// Cells of all levels.
  void expect_equal(const std::string& a, const std::string& b) {
    const MapReader first(folder / a);
    const MapReader second(folder / b);
    ASSERT_EQ(first.info().levels, second.info().levels);
    for (int level = 0; level < first.info().levels; ++level) {
      ASSERT_EQ(first.tiles(level), second.tiles(level));
      for (const TileIndex tile : first.tiles(level)) EXPECT_EQ(first.tile(level, tile), second.tile(level, tile));
    }
  }
  testing::TemporaryFolder folder;
};

TEST_F(IngestTest, PlansTheTilesThatTheSourceTouches) {
  const std::vector<TileIndex> blocks = plan_blocks(NoiseSource(), "noise", kSettings);
  EXPECT_EQ(blocks.size(), 6U * 5U);  // tiles of 512 m
  EXPECT_TRUE(std::ranges::is_sorted(blocks, {}, [](TileIndex t) { return std::pair(t.row, t.col); }));
}

TEST_F(IngestTest, PlansNoGroundWithoutLatitudeAndLongitude) {
  NoiseSource source;
  source.set_extent({{998000.0, 4200100.0}, {1003000.0, 4201000.0}});
  for (const TileIndex block : plan_blocks(source, "noise", kSettings)) {
    const GridBox ground = tile_geometry(block, kSettings.cell_m).box();
    EXPECT_NO_THROW(kSettings.zone.unproject(ground.max)) << ground.max.east_m;
  }
  source.set_extent({{1001000.0, 4200100.0}, {1003000.0, 4201000.0}});
  EXPECT_EQ(testing::code_of([&] { plan_blocks(source, "noise", kSettings); }), "source-outside-map");
}

TEST_F(IngestTest, PlansNoMoreThanAMillionBlocksAndSaysHowLargeTheSourceIs) {
  NoiseSource source;
  source.set_extent({{400000.0, 4200000.0}, {500000.0, 4364000.0}});
  const MapSettings fine{kSettings.zone, 0.5};
  EXPECT_THAT(testing::message_of([&] { plan_blocks(source, "noise", fine); }),
              ::testing::HasSubstr("'noise' covers 100 x 164 km, more than a million blocks of 128 m"));
}

TEST_F(IngestTest, CarriesEveryCellIntoTheMap) {
  const NoiseSource source;
  const IngestReport report = run(source, "a.gpkg", 2);
  const MapReader map(folder / "a.gpkg");
  EXPECT_EQ(report.blocks, std::ssize(plan_blocks(source, "noise", kSettings)));
  EXPECT_EQ(report.blocks_before, 0);
  EXPECT_EQ(report.observed_cells, 1400 * 1100);
  for (const TileIndex tile : plan_blocks(source, "noise", kSettings)) {
    EXPECT_EQ(map.tile(0, tile), source.read(tile_geometry(tile, kSettings.cell_m), block_seed(5, tile)));
  }
}

TEST_F(IngestTest, GivesTheSameMapWithAnyNumberOfJobs) {
  run(NoiseSource(), "one.gpkg", 1);
  run(NoiseSource(), "four.gpkg", 4);
  expect_equal("one.gpkg", "four.gpkg");
}

TEST_F(IngestTest, StoppedAnywhereItGoesOnWhereItWas) {
  run(NoiseSource(), "whole.gpkg", 1);
  std::int64_t before = 0;
  for (int i = 0; i < 3; ++i) {
    NoiseSource part;
    part.stop_at(5);
    try {
      run(part, "parts.gpkg", 2, part.stop());
      FAIL() << "not stopped";
    } catch (const Interrupted& error) {
      EXPECT_EQ(error.code(), "work-stopped");
      EXPECT_THAT(error.what(), ::testing::HasSubstr("run the same command again"));
    }
    EXPECT_LE(part.reads(), 5 + 4) << "more than the blocks in flight";
    before += part.reads();
  }
  const NoiseSource rest;
  const IngestReport report = run(rest, "parts.gpkg", 2);
  EXPECT_EQ(report.blocks_before, before);
  EXPECT_EQ(rest.reads(), report.blocks - before);
  expect_equal("whole.gpkg", "parts.gpkg");
}

TEST_F(IngestTest, ADamagedBlockIsReportedAndNothingHalfDoneCounts) {
  run(NoiseSource(), "whole.gpkg", 1);
  NoiseSource damaged;
  damaged.fail_at(9);
  try {
    run(damaged, "parts.gpkg", 2);
    FAIL() << "nothing thrown";
  } catch (const CorruptData& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("a.tif"));
  }
  EXPECT_LE(damaged.reads(), 9 + 4) << "more than the blocks in flight";
  EXPECT_FALSE(MapReader(folder / "parts.gpkg").info().sources.front().complete);
  const IngestReport report = run(NoiseSource(), "parts.gpkg", 2);
  EXPECT_EQ(report.blocks_before, damaged.reads() - 1) << "what could be read beside the damaged block is kept";
  expect_equal("whole.gpkg", "parts.gpkg");
}

TEST_F(IngestTest, AFinishedSourceNeedsNothing) {
  const IngestReport first = run(NoiseSource(), "a.gpkg", 2);
  const NoiseSource again;
  EXPECT_EQ(run(again, "a.gpkg", 2).blocks_before, first.blocks);
  EXPECT_EQ(again.reads(), 0);
}

TEST_F(IngestTest, SaysHowFarItIs) {
  MapWriter writer(folder / "a.gpkg", kSettings);
  std::vector<std::int64_t> seen;
  std::int64_t blocks = 0;
  const auto note = [&](std::int64_t done, std::int64_t total) {
    blocks = total;
    seen.push_back(done);
  };
  ingest(NoiseSource(), record(), writer, {.jobs = 2, .seed = 5, .on_blocks = note});
  ASSERT_EQ(std::ssize(seen), blocks + 1);
  EXPECT_TRUE(std::ranges::is_sorted(seen));
  EXPECT_EQ(seen.back(), blocks);
}

TEST_F(IngestTest, WritesBlocksWhileItReadsOthers) {
  NoiseSource slow;
  slow.take(std::chrono::milliseconds(15));
  MapWriter writer(folder / "a.gpkg", kSettings);
  std::int64_t read_before_first = 0;
  const auto note = [&](std::int64_t done, std::int64_t) {
    if (done == 1) read_before_first = slow.reads();
  };
  const IngestReport report = ingest(slow, record(), writer, {.jobs = 1, .seed = 5, .on_blocks = note});
  EXPECT_GT(read_before_first, 0);
  EXPECT_LT(read_before_first, report.blocks) << "one that is killed loses all of them";
}

TEST(BlockSeed, DiffersBetweenBlocksAndRuns) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    for (int col = 0; col < 40; ++col) {
      for (int row = -40; row < 0; ++row) seeds.insert(block_seed(seed, {col, row}));
    }
  }
  EXPECT_EQ(seeds.size(), 3U * 40U * 40U);
}

}  // namespace
}  // namespace roadfix
