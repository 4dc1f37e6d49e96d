// The heights of a map's ground.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "tests/support/code_of.hpp"
#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/store/map_verifier.hpp"

namespace roadfix {
namespace {

using testing::code_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::settings_37n;
using ::testing::SizeIs;
using testing::some_blocks;

const TerrainRecord kRecord{.location = "a.tif, b.tif",
                            .provenance = {.date = "2021", .licence = "free", .attribution = "DLR e.V."}};

/// Around the blocks of the map, 433,664 to 434,688 m east and 4,179,456 to 4,180,480 m north, on parts of four tiles.
/// Unknown are two cells, and all of the south-eastern tile.
Terrain hills() {
  Terrain terrain = Terrain::unknown({32.0, {13'551, -130'641}, 40, 90});
  for (int row = 0; row < 90; ++row) {
    for (int col = 0; col < 40; ++col) {
      if ((row == 3 && col == 4) || (row == 20 && col == 13) || (col >= 17 && row >= 81)) continue;
      terrain.codes[static_cast<std::size_t>(40 * row + col)] = Terrain::code_of(600.0 + 3.0 * col - 2.0 * row);
    }
  }
  return terrain;
}

class TerrainTable : public ::testing::Test {
 protected:
  TerrainTable() : path(folder / "m.gpkg"), writer(path, settings_37n()) {
    testing::ingest(writer, {"a", 1, some_blocks(2)});
  }
  MapInfo info() const { return MapReader(path).info(); }
  void execute(const char* sql) const { testing::open_sqlite(path).execute(sql); }

  testing::TemporaryFolder folder;
  std::filesystem::path path;
  MapWriter writer;
};

TEST_F(TerrainTable, GivesBackWhatWasPutInAndSaysWhereItCameFrom) {
  EXPECT_FALSE(info().terrain);
  writer.put_terrain(hills(), kRecord);
  const auto status = info().terrain;
  ASSERT_TRUE(status);
  EXPECT_EQ(*status->terrain, hills());
  EXPECT_EQ(status->record, kRecord);
  EXPECT_THAT(status->added_at, ::testing::StartsWith("20"));
  EXPECT_NEAR(status->heights.lowest_m, 600.0 - 2.0 * 89, 0.11);
  EXPECT_NEAR(status->heights.highest_m, 600.0 + 3.0 * 39, 0.11);
  EXPECT_THAT(verify_map(path).problems, IsEmpty());
}

TEST_F(TerrainTable, HasNoTileWhereAllIsUnknown) {
  writer.put_terrain(hills(), kRecord);
  sqlite::Connection map = testing::open_sqlite(path);
  EXPECT_EQ(sqlite::number(map, "SELECT count(*) FROM roadfix_terrain"), 3);
}

TEST_F(TerrainTable, ChangesNeitherTheTilesNorTheVersionOfTheMap) {
  const auto tiles = testing::tile_bytes(path);
  const std::string version = info().version;
  writer.put_terrain(hills(), kRecord);
  EXPECT_EQ(info().version, version);
  EXPECT_EQ(testing::tile_bytes(path), tiles);
}

TEST_F(TerrainTable, TellsHowMuchOfTheExtentIsKnown) {
  writer.put_terrain(hills(), kRecord);
  EXPECT_EQ(info().terrain->known_share, 1.0 - 2.0 / (32 * 32));
  Terrain beside = hills();
  beside.geometry.origin.col += 16;
  writer.put_terrain(beside, kRecord);
  EXPECT_NEAR(info().terrain->known_share, 0.5, 0.05);
  beside.geometry.origin.col += 1000;
  writer.put_terrain(beside, kRecord);
  EXPECT_EQ(info().terrain->known_share, 0.0);
}

TEST_F(TerrainTable, TakesThePlaceOfWhatWasThere) {
  writer.put_terrain(hills(), kRecord);
  Terrain coarse = Terrain::unknown({4096.0, {105, -1021}, 2, 1});
  coarse.codes[1] = Terrain::code_of(-20.0);
  writer.put_terrain(coarse, {.location = "c.tif"});
  EXPECT_EQ(*info().terrain->terrain, coarse);
  EXPECT_EQ(info().terrain->record.location, "c.tif");
}

TEST_F(TerrainTable, LeavesNoTableBehindWhenItIsTakenOut) {
  const auto tables = [&] {
    sqlite::Connection map = testing::open_sqlite(path);
    return sqlite::number(map,
                          "SELECT (SELECT count(*) FROM sqlite_master) + 1000 * (SELECT count(*) FROM "
                          "gpkg_extensions)");
  };
  const std::int64_t before = tables();
  EXPECT_FALSE(writer.remove_terrain());
  writer.put_terrain(hills(), kRecord);
  EXPECT_GT(tables(), before);
  EXPECT_TRUE(writer.remove_terrain());
  EXPECT_EQ(tables(), before);
  EXPECT_FALSE(info().terrain);
}

TEST_F(TerrainTable, StaysAsItIsWhileReadersReadIt) {
  writer.put_terrain(hills(), kRecord);
  const MapReader reader(path);
  writer.remove_terrain();
  EXPECT_EQ(*reader.info().terrain->terrain, hills());
  EXPECT_NO_THROW(reader.read({2.0, {847 * 256, -8165 * 256}, 10, 10})) << "no tile has changed";
}

TEST_F(TerrainTable, NamesADamagedTileAndIsWholeWithoutItAfterRepair) {
  writer.put_terrain(hills(), kRecord);
  execute(
      "UPDATE roadfix_terrain SET tile_data = x'89504e47' WHERE tile_row = (SELECT min(tile_row) FROM "
      "roadfix_terrain) AND tile_column = (SELECT max(tile_column) FROM roadfix_terrain)");
  EXPECT_EQ(code_of([&] { MapReader reader(path); }), "terrain-corrupt");
  const std::string message = message_of([&] { MapReader reader(path); });
  EXPECT_THAT(message, HasSubstr(path.string()));
  EXPECT_THAT(message, HasSubstr("tile column 53 row 769"));
  EXPECT_THAT(message, HasSubstr("roadfix terrain"));
  const auto problems = verify_map(path).problems;
  ASSERT_THAT(problems, SizeIs(1));
  EXPECT_EQ(problems.front().code, "terrain-damaged");
  EXPECT_THAT(problems.front().what, HasSubstr("--repair"));

  EXPECT_THAT(writer.repair_terrain(), ElementsAre(HasSubstr("tile column 53 row 769")));
  EXPECT_THAT(verify_map(path).problems, IsEmpty());
  const Terrain left = *info().terrain->terrain;
  EXPECT_EQ(left.cell_height_m(0, 0), hills().cell_height_m(0, 0));
  EXPECT_FALSE(left.cell_height_m(30, 0));
  EXPECT_THAT(writer.repair_terrain(), IsEmpty());
}

TEST_F(TerrainTable, IsGoneAfterRepairWhereNothingOfItCanBeRead) {
  for (const char* damage :
       {"UPDATE roadfix_terrain SET tile_data = x'00'", "DELETE FROM roadfix_terrain",
        "UPDATE roadfix_terrain SET tile_column = 4294967296 + 53", "UPDATE roadfix_terrain SET tile_column = 54",
        "DELETE FROM roadfix_terrain_source", "DROP TABLE roadfix_terrain_source",
        "UPDATE roadfix_terrain_source SET cell_m = 48", "UPDATE roadfix_terrain_source SET cell_m = 0",
        "UPDATE roadfix_terrain_source SET cell_m = 'fine'", "UPDATE roadfix_terrain_source SET max_x = 9e999",
        "UPDATE roadfix_terrain_source SET max_x = max_x + 1", "UPDATE roadfix_terrain_source SET max_x = min_x",
        "UPDATE roadfix_terrain_source SET min_x = 0, min_y = 0, max_x = 1048576, max_y = 10485760"}) {
    writer.put_terrain(hills(), kRecord);
    execute("DELETE FROM roadfix_terrain WHERE id > 1");
    execute(damage);
    EXPECT_THROW(MapReader reader(path), CorruptData) << damage;
    EXPECT_THAT(verify_map(path).problems, ElementsAre(::testing::Field(&MapProblem::code, "terrain-damaged")))
        << damage;
    EXPECT_THAT(writer.repair_terrain(), SizeIs(1)) << damage;
    EXPECT_FALSE(info().terrain) << damage;
    EXPECT_THAT(verify_map(path).problems, IsEmpty()) << damage;
  }
}

TEST_F(TerrainTable, MakesAMapNoOtherThanItWasToOlderProgramsThatKnowOfNone) {
  writer.put_terrain(hills(), kRecord);
  sqlite::Connection map = testing::open_sqlite(path);
  EXPECT_EQ(sqlite::number(map, "SELECT value FROM roadfix_meta WHERE key = 'schema_version'"), 2);
  EXPECT_EQ(sqlite::number(map, "SELECT count(*) FROM gpkg_contents"), 1);
  EXPECT_EQ(sqlite::number(map, "SELECT count(*) FROM roadfix_sources"), 1);
}

}  // namespace
}  // namespace roadfix
