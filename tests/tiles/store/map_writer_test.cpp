#include "tiles/store/map_writer.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "core/grid/resample.hpp"
#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"
#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/store/fusion.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using testing::ingest;
using testing::message_of;
using testing::put_block;
using testing::random_cells;
using testing::settings_37n;
using testing::some_blocks;
using testing::TemporaryFolder;
using testing::TestSource;
using testing::tile_bytes;

TEST(MapWriter, WhatWasPutCanBeRead) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  const TestSource source{"a", 1, some_blocks(2)};
  {
    MapWriter writer(path, settings_37n());
    ingest(writer, source);
  }
  const MapReader reader(path);
  for (const TileIndex block : source.blocks) EXPECT_EQ(reader.tile(0, block), random_cells(1, block));
  EXPECT_EQ(reader.info().tiles, 4);
  EXPECT_EQ(reader.info().levels, 8);
  EXPECT_EQ(reader.info().pending, 0);
  ASSERT_EQ(reader.info().sources.size(), 1U);
  const SourceStatus& status = reader.info().sources.front();
  EXPECT_TRUE(status.complete);
  EXPECT_EQ(status.blocks_done, 4);
  EXPECT_EQ(status.record.provenance.licence, "CC BY 4.0");
  EXPECT_EQ(status.record.provenance.registration_sigma_m, 2.5);
  EXPECT_FALSE(status.ingested_at.empty());
  EXPECT_FALSE(std::filesystem::exists(path.string() + "-journal"));
  EXPECT_FALSE(std::filesystem::exists(path.string() + "-writer"));
}

TEST(MapWriter, TellsWhichBlocksOfASourceItHoldsWholeOrInterrupted) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  const TestSource older{"a", 1, some_blocks(2)};
  const TestSource newer{"a", 2, some_blocks(2)};
  EXPECT_TRUE(finished_blocks(path, older.record()).empty());
  MapWriter writer(path, settings_37n());
  ingest(writer, older);
  writer.begin_source(newer.record(), newer.blocks, true);
  EXPECT_TRUE(finished_blocks(path, newer.record()).empty());
  put_block(writer, "a", newer.blocks[3], random_cells(2, newer.blocks[3]));
  EXPECT_EQ(finished_blocks(path, newer.record()), std::set{newer.blocks[3]});
  EXPECT_EQ(finished_blocks(path, older.record()).size(), 4U);
  EXPECT_EQ(blocks_in_force(path, "a").size(), 4U);
  EXPECT_TRUE(blocks_in_force(path, "b").empty());
}

TEST(MapWriter, SeveralBlocksAreOneTransaction) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  const TestSource source{"a", 1, some_blocks(2)};
  MapWriter writer(path, settings_37n());
  std::vector<FinishedBlock> blocks;
  for (const TileIndex block : writer.begin_source(source.record(), source.blocks, false)) {
    blocks.push_back({block, random_cells(1, block)});
  }
  const auto done = [&] { return MapReader(path).info().sources.front().blocks_done; };
  blocks.push_back({{0, 0}, CellArray(kTileCells, kTileCells)});
  EXPECT_EQ(code_of([&] { writer.put_blocks("a", blocks); }), "block-not-expected");
  EXPECT_EQ(done(), 0) << "all or none";
  blocks.pop_back();
  writer.put_blocks("a", blocks);
  EXPECT_EQ(done(), 4);
  writer.finish_source("a");
  const MapReader reader(path);
  for (const TileIndex block : source.blocks) EXPECT_EQ(reader.tile(0, block), random_cells(1, block));
}

TEST(MapWriter, OverviewsAreTheHalvedLevelBelow) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  ingest(writer, {"a", 1, some_blocks(3)});
  const MapReader reader(folder / "m.gpkg");
  for (int level = 1; level < reader.info().levels; ++level) {
    const auto tiles = reader.tiles(level);
    EXPECT_FALSE(tiles.empty());
    for (const TileIndex tile : tiles) {
      CellArray below(512, 512);
      for (const TileIndex child : {TileIndex{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        const auto cells = reader.tile(level - 1, {2 * tile.col + child.col, 2 * tile.row + child.row});
        if (cells) paste(*cells, below, 256 * child.col, 256 * child.row);
      }
      EXPECT_EQ(reader.tile(level, tile), halved(below));
    }
  }
}

TEST(MapWriter, TheExtentIsThatOfTheObservedCells) {
  const TemporaryFolder folder;
  const TileIndex block{847, -8165};
  CellArray cells(kTileCells, kTileCells);
  cells.at(10, 20) = kNoRoad;
  cells.at(30, 25) = kRoad;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  EXPECT_TRUE(MapReader(folder / "m.gpkg").info().extent.empty());
  writer.begin_source(TestSource{"a", 1, {}}.record(), std::vector{block}, false);
  put_block(writer, "a", block, cells);
  writer.finish_source("a");
  const GridBox box = MapReader(folder / "m.gpkg").info().extent;
  const GridGeometry tile = tile_geometry(block, 2.0);
  EXPECT_EQ(box.min, (GridPoint{tile.box().min.east_m + 20, tile.box().max.north_m - 52}));
  EXPECT_EQ(box.max, (GridPoint{tile.box().min.east_m + 62, tile.box().max.north_m - 40}));
  writer.remove_source("a");
  EXPECT_TRUE(MapReader(folder / "m.gpkg").info().extent.empty());
}

TEST(MapWriter, SouthernZonesHaveTheSameLattice) {
  const TemporaryFolder folder;
  const MapSettings settings{*UtmZone::from_epsg(32734), 1.0};  // Swellendam, South Africa
  const GridPoint place = settings.zone.project({-34.02, 20.44});
  const auto blocks =
      tiles_covering(GridGeometry::covering({place, {place.east_m + 300, place.north_m + 300}}, settings.cell_m));
  MapWriter writer(folder / "m.gpkg", settings);
  ingest(writer, {"a", 1, blocks});
  const MapReader reader(folder / "m.gpkg");
  EXPECT_EQ(reader.info().settings.zone.epsg(), 32734);
  EXPECT_EQ(reader.tile(0, blocks.front()), random_cells(1, blocks.front()));
}

TEST(MapWriter, TheFusedMapDependsOnNoOrderOfIngestion) {
  const TemporaryFolder folder;
  std::vector<TestSource> sources{{"a", 1, some_blocks(2)}, {"b", 2, some_blocks(2, 1)}, {"c", 3, some_blocks(1, 1)}};
  testing::TileBytes expected;
  std::string version;
  std::vector<std::size_t> order{0, 1, 2};
  int run = 0;
  do {
    const auto path = folder / (std::to_string(run++) + ".gpkg");
    MapWriter writer(path, settings_37n());
    for (const std::size_t i : order) ingest(writer, sources[i]);
    if (expected.empty()) {
      expected = tile_bytes(path);
      version = MapReader(path).info().version;
    }
    EXPECT_EQ(tile_bytes(path), expected);
    EXPECT_EQ(MapReader(path).info().version, version);
  } while (std::ranges::next_permutation(order).found);
  const TileIndex shared = some_blocks(1, 1).front();
  EXPECT_EQ(MapReader(folder / "0.gpkg").tile(0, shared),
            fused(std::vector{random_cells(1, shared), random_cells(2, shared), random_cells(3, shared)}));
}

TEST(MapWriter, SaysThatTheSameSourceWasMadeByAnotherDetector) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  const TestSource source{"a", 1, some_blocks(2)};
  ingest(writer, source);
  SourceRecord updated = source.record();
  updated.fingerprint = "of today's detector";
  updated.method = "neural 2";
  const auto message = [&] { return message_of([&] { writer.begin_source(updated, source.blocks, false); }); };
  EXPECT_THAT(message(), ::testing::HasSubstr("(made by tree; now it is neural 2)"));
  updated.method = source.record().method;
  EXPECT_THAT(message(), ::testing::Not(::testing::HasSubstr("made by")));
  updated.content = SourceContent::kRoads;
  EXPECT_THAT(message(), ::testing::HasSubstr("(as imagery; now it is roads)"));
}

TEST(MapWriter, AReplacedSourceStaysInForceUntilTheNewOneIsComplete) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  MapWriter writer(path, settings_37n());
  const TestSource old_source{"a", 1, some_blocks(2)};
  const TestSource new_source{"a", 2, some_blocks(2, 1)};
  ingest(writer, old_source);
  const auto before = tile_bytes(path);
  EXPECT_EQ(code_of([&] { writer.begin_source(new_source.record(), new_source.blocks, false); }), "source-exists");
  for (const TileIndex block : writer.begin_source(new_source.record(), new_source.blocks, true)) {
    put_block(writer, "a", block, random_cells(2, block));
    EXPECT_EQ(tile_bytes(path), before);
  }
  const MapInfo during = MapReader(path).info();
  ASSERT_EQ(during.sources.size(), 2U);
  EXPECT_TRUE(during.sources[0].complete);
  EXPECT_FALSE(during.sources[1].complete);
  writer.finish_source("a");

  const auto fresh = folder / "fresh.gpkg";
  MapWriter fresh_writer(fresh, settings_37n());
  ingest(fresh_writer, new_source);
  EXPECT_EQ(tile_bytes(path), tile_bytes(fresh));
  EXPECT_EQ(MapReader(path).info().version, MapReader(fresh).info().version);
  EXPECT_EQ(MapReader(path).info().sources.size(), 1U);
}

TEST(MapWriter, ASourceBegunAnewWithOtherContentKeepsNothingOfWhatWasBegunBefore) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  MapWriter writer(path, settings_37n());
  const TestSource begun{"a", 1, some_blocks(2)};
  const TestSource changed{"a", 2, some_blocks(2)};
  put_block(writer, "a", writer.begin_source(begun.record(), begun.blocks, false).front(), CellArray(256, 256, kRoad));
  EXPECT_EQ(writer.begin_source(changed.record(), changed.blocks, true), changed.blocks);
  EXPECT_EQ(MapReader(path).info().sources.size(), 1U);
  ingest(writer, changed, true);
  MapWriter fresh(folder / "fresh.gpkg", settings_37n());
  ingest(fresh, changed);
  EXPECT_EQ(tile_bytes(path), tile_bytes(folder / "fresh.gpkg"));
}

TEST(MapWriter, RemovingASourceLeavesTheMapOfTheOthers) {
  const TemporaryFolder folder;
  MapWriter both(folder / "both.gpkg", settings_37n());
  MapWriter one(folder / "one.gpkg", settings_37n());
  ingest(both, {"a", 1, some_blocks(2)});
  ingest(both, {"b", 2, some_blocks(2, 1)});
  ingest(one, {"a", 1, some_blocks(2)});
  both.remove_source("b");
  EXPECT_EQ(tile_bytes(folder / "both.gpkg"), tile_bytes(folder / "one.gpkg"));
  EXPECT_EQ(MapReader(folder / "both.gpkg").info().version, MapReader(folder / "one.gpkg").info().version);
  EXPECT_FALSE(both.remove_source("b")) << "what should follow may have been stopped";
  both.put_shifts({});
  EXPECT_EQ(code_of([&] { both.remove_source("b"); }), "source-not-found");
}

TEST(MapWriter, ACompleteSourceNeedsNothingMore) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "m.gpkg", settings_37n());
  TestSource source{"a", 1, some_blocks(2)};
  ingest(writer, source);
  const auto before = tile_bytes(folder / "m.gpkg");
  EXPECT_TRUE(writer.begin_source(source.record(), source.blocks, false).empty());
  EXPECT_TRUE(writer.begin_source(source.record(), source.blocks, true).empty());
  writer.finish_source("a");
  EXPECT_EQ(tile_bytes(folder / "m.gpkg"), before);
}

TEST(MapWriter, AWorkListThatNoWriterMadeIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  for (const char* row : {"40, 1, 1", "11, -1, 1", "11, 1, 4294967297"}) {
    MapWriter writer(path, settings_37n());
    ingest(writer, {"a", 1, some_blocks(1)});
    sqlite::Connection map = testing::open_sqlite(path);
    map.execute((std::string("INSERT INTO roadfix_pending VALUES (") + row + ")").c_str());
    EXPECT_EQ(code_of([&] { writer.finish_source("a"); }), "map-corrupt") << row;
    map.execute("DELETE FROM roadfix_pending");
  }
}

TEST(MapWriter, OnlyOneWriterHoldsAMap) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  {
    const MapWriter first(path, settings_37n());
    EXPECT_EQ(code_of([&] { MapWriter(path, settings_37n()); }), "map-in-use");
  }
  EXPECT_EQ(code_of([&] { MapWriter(path, settings_37n()); }), "no error");
}

TEST(MapWriter, SaysThatItsMapWasMovedWhereWhatWasFinishedStaysWhole) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  const auto elsewhere = folder / "moved.gpkg";
  const TestSource source{"a", 1, some_blocks(2)};
  {
    MapWriter writer(path, settings_37n());
    const std::vector<TileIndex> blocks = writer.begin_source(source.record(), source.blocks, false);
    put_block(writer, "a", blocks[0], random_cells(1, blocks[0]));
    std::filesystem::rename(path, elsewhere);
    const auto go_on = [&] { put_block(writer, "a", blocks[1], random_cells(1, blocks[1])); };
    EXPECT_EQ(code_of(go_on), "map-not-writable");
    EXPECT_THAT(message_of(go_on), ::testing::HasSubstr("moved, removed or replaced while it was written to"));
  }
  EXPECT_EQ(MapReader(elsewhere).info().sources.front().blocks_done, 1);
}

TEST(MapWriter, RefusesWhatDoesNotFit) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  EXPECT_FALSE(info_of(path));
  EXPECT_EQ(code_of([&] { MapWriter::existing(path); }), "map-not-found");
  EXPECT_EQ(code_of([&] { MapWriter(path, settings_37n(3.0)); }), "cell-size-not-supported");
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(code_of([&] { MapWriter(folder / "no/such/folder/m.gpkg", settings_37n()); }), "map-not-writable");
  MapWriter writer(path, settings_37n(2.0));
  EXPECT_EQ(info_of(path).value().settings, settings_37n(2.0));
  EXPECT_EQ(code_of([&] { put_block(writer, "a", {847, -8165}, CellArray(256, 256)); }), "block-not-expected");
  const std::vector<TileIndex> outside{{5000, -8165}};
  EXPECT_EQ(code_of([&] {
              writer.begin_source(TestSource{"a", 1, {}}.record(), outside, false);
            }),
            "block-outside-zone");
  EXPECT_EQ(code_of([&] { writer.finish_source("a"); }), "source-not-found");
}

TEST(MapWriter, AnExistingMapKeepsItsSettings) {
  const TemporaryFolder folder;
  const auto path = folder / "m.gpkg";
  EXPECT_EQ(code_of([&] { MapWriter(path, settings_37n(2.0)); }), "no error");
  EXPECT_EQ(code_of([&] { MapWriter(path, settings_37n(1.0)); }), "map-settings-differ");
  EXPECT_EQ(code_of([&] { MapWriter(path, {*UtmZone::from_epsg(32636), 2.0}); }), "map-settings-differ");
}

TEST(MapWriter, WritesWhereALinkLeadsThoughNothingIsThereYet) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "disk");
  const auto map = folder / "disk/m.gpkg";
  const auto alias = folder / "alias.gpkg";
  std::filesystem::create_symlink("m.gpkg", folder / "disk/other.gpkg");
  std::filesystem::create_symlink("disk/other.gpkg", alias);
  {
    MapWriter writer(alias, settings_37n());
    ingest(writer, {"a", 1, some_blocks(1)});
    EXPECT_EQ(code_of([&] { MapWriter(map, settings_37n()); }), "map-in-use");
  }
  EXPECT_TRUE(std::filesystem::is_symlink(alias));
  EXPECT_EQ(MapReader(map).info().sources.size(), 1U);
  std::filesystem::create_symlink("loop.gpkg", folder / "loop.gpkg");
  EXPECT_EQ(code_of([&] { MapWriter(folder / "loop.gpkg", settings_37n()); }), "map-io");
}

}  // namespace
}  // namespace roadfix
