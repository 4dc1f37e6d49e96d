// What a writer leaves behind that was stopped, thrown away or killed, and the one that goes on after it.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/code_of.hpp"
#include "tests/support/repeats.hpp"
#include "tests/support/room.hpp"
#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::ingest;
using testing::put_block;
using testing::random_cells;
using testing::settings_37n;
using testing::some_blocks;
using testing::TemporaryFolder;
using testing::TestSource;
using testing::tile_bytes;

TEST(InterruptedWriter, ASourceGoesOnWhereAWriterWasThrownAway) {
  const TemporaryFolder folder;
  const TestSource source{"a", 1, some_blocks(3)};
  {
    MapWriter writer(folder / "whole.gpkg", settings_37n());
    ingest(writer, source);
  }
  const auto path = folder / "m.gpkg";
  for (std::size_t done = 0; done <= source.blocks.size(); ++done) {
    MapWriter writer(path, settings_37n());
    const auto open = writer.begin_source(source.record(), source.blocks, false);
    ASSERT_EQ(open.size(), source.blocks.size() - done);
    if (open.empty()) {
      writer.finish_source("a");
    } else {
      put_block(writer, "a", open.front(), random_cells(1, open.front()));
      if (open.size() > 1) {
        EXPECT_EQ(code_of([&] { writer.finish_source("a"); }), "source-incomplete");
      }
    }
  }
  EXPECT_EQ(tile_bytes(path), tile_bytes(folder / "whole.gpkg"));
}

TEST(InterruptedWriter, FusingCanBeStoppedAndRepeated) {
  const TemporaryFolder folder;
  const TestSource source{"a", 1, some_blocks(10)};
  const auto path = folder / "m.gpkg";
  MapWriter writer(path, settings_37n());
  for (const TileIndex block : writer.begin_source(source.record(), source.blocks, false)) {
    CellArray cells(kTileCells, kTileCells);
    cells.at(3, 4) = kRoad;
    put_block(writer, "a", block, cells);
  }
  std::stop_source stop;
  const auto stop_midway = [&](std::int64_t done, std::int64_t) {
    if (done > 0) stop.request_stop();
  };
  EXPECT_EQ(code_of([&] { writer.finish_source("a", stop_midway, stop.get_token()); }), "work-stopped");
  EXPECT_GT(MapReader(path).info().pending, 0);
  writer.finish_source("a");
  EXPECT_EQ(MapReader(path).info().pending, 0);
  EXPECT_EQ(MapReader(path).info().tiles, 100);
}

TEST(InterruptedWriter, RemovingASourceCanBeStoppedAndRepeated) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  MapWriter one(folder / "one.gpkg", settings_37n());
  ingest(one, {"a", 1, some_blocks(2)});
  MapWriter writer(path, settings_37n());
  ingest(writer, {"a", 1, some_blocks(2)});
  ingest(writer, {"b", 2, some_blocks(2, 1)});
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_EQ(code_of([&] { writer.remove_source("b", {}, stopped.get_token()); }), "work-stopped");
  EXPECT_GT(MapReader(path).info().pending, 0);
  EXPECT_FALSE(writer.remove_source("b")) << "it has gone already";
  EXPECT_EQ(MapReader(path).info().pending, 0);
  EXPECT_EQ(tile_bytes(path), tile_bytes(folder / "one.gpkg"));
}

TEST(InterruptedWriter, OnlyANewMapWithoutAFinishedBlockIsRemoved) {
  const TemporaryFolder folder;
  const TestSource source{"a", 1, some_blocks(2)};
  {
    MapWriter failed(folder / "new.gpkg", settings_37n());
    failed.begin_source(source.record(), source.blocks, false);
    failed.remove_if_new_and_empty();
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  {
    MapWriter begun(folder / "begun.gpkg", settings_37n());
    begun.begin_source(source.record(), source.blocks, false);
    put_block(begun, "a", source.blocks.front(), CellArray(256, 256));
    begun.remove_if_new_and_empty();
  }
  EXPECT_EQ(MapReader(folder / "begun.gpkg").info().sources.front().blocks_done, 1);
  { const MapWriter made_before(folder / "old.gpkg", settings_37n()); }
  MapWriter(folder / "old.gpkg", settings_37n()).remove_if_new_and_empty();
  EXPECT_TRUE(std::filesystem::exists(folder / "old.gpkg"));
}

TEST(InterruptedWriter, WhatWasReplacedOrRemovedCountsWithItsErrorUntilNoTileShowsItAnyMore) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  MapWriter writer(path, settings_37n());
  const auto put = [&](double sigma_m, std::uint64_t seed, bool replace, std::stop_token stop) {
    SourceRecord record = TestSource{"a", seed, {}}.record();
    record.provenance.registration_sigma_m = sigma_m;
    for (const TileIndex block : writer.begin_source(record, some_blocks(2), replace)) {
      put_block(writer, "a", block, random_cells(seed, block));
    }
    writer.finish_source("a", {}, stop);
  };
  ingest(writer, {"b", 9, some_blocks(2)});  // 2.5 m
  const GridBox box = tile_geometry(some_blocks(1).front(), 2.0).box();
  const auto error_m = [&] { return MapReader(path).registration_sigma_m(box); };
  put(40.0, 1, false, {});
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_EQ(code_of([&] { put(2.0, 2, true, stopped.get_token()); }), "work-stopped");
  EXPECT_EQ(error_m(), 40.0);
  EXPECT_EQ(code_of([&] { put(3.0, 3, true, stopped.get_token()); }), "work-stopped");
  EXPECT_EQ(error_m(), 40.0) << "no tile shows the one between, and all show the first";
  EXPECT_EQ(MapReader(path).info().error_of_removed_m, 40.0);
  writer.finish_source("a");
  EXPECT_EQ(error_m(), 3.0);
  EXPECT_EQ(MapReader(path).info().error_of_removed_m, 0.0);
  EXPECT_EQ(code_of([&] { put(2.0, 4, true, stopped.get_token()); }), "work-stopped");
  EXPECT_EQ(error_m(), 3.0) << "no tile shows the first any more";
  writer.finish_source("a");
  put(4.0, 5, true, {});
  EXPECT_EQ(code_of([&] { writer.remove_source("a", {}, stopped.get_token()); }), "work-stopped");
  EXPECT_EQ(error_m(), 4.0);
  writer.remove_source("a");
  EXPECT_EQ(error_m(), 2.5);
}

/// Two sources, the second replaced by a third: every kind of transaction of a writer.
void ingest_everything(const std::filesystem::path& path) {
  MapWriter writer(path, settings_37n());
  const TestSource a{"a", 1, some_blocks(2)};
  const TestSource b{"b", 2, some_blocks(2, 1)};
  const TestSource replacement{"b", 3, some_blocks(1, 1)};
  ingest(writer, a);
  const auto sources = MapReader(path).info().sources;
  const bool replaced = std::ranges::any_of(
      sources, [&](const SourceStatus& s) { return s.record.fingerprint == replacement.record().fingerprint; });
  if (!replaced) ingest(writer, b);
  ingest(writer, replacement, true);
}

TEST(InterruptedWriter, AKilledProcessLosesNothing) {
  const TemporaryFolder folder;
  const auto started = std::chrono::steady_clock::now();
  ingest_everything(folder / "whole.gpkg");
  const auto duration = std::chrono::steady_clock::now() - started;
  const auto expected = tile_bytes(folder / "whole.gpkg");
  const auto version = MapReader(folder / "whole.gpkg").info().version;

  constexpr int kRuns = 4 * testing::repeats(4);
  for (int run = 0; run < kRuns; ++run) {
    const auto path = folder / (std::to_string(run) + ".gpkg");
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      ingest_everything(path);
      _exit(0);
    }
    std::this_thread::sleep_for(duration * run / kRuns);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    ingest_everything(path);
    EXPECT_EQ(tile_bytes(path), expected) << "killed after " << run << "/" << kRuns;
    EXPECT_EQ(MapReader(path).info().version, version);
    EXPECT_EQ(MapReader(path).info().pending, 0);
  }
}

TEST(InterruptedWriter, ADiskWithoutRoomForANewMapIsLeftAsItWas) {
  const TemporaryFolder folder;
  const testing::Room room(100);
  EXPECT_THROW(MapWriter(folder / "new.gpkg", settings_37n()), IoFailure);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace roadfix
