#include "tiles/store/map_file.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "core/units/error.hpp"
#include "tests/support/as_another_user.hpp"
#include "tests/support/code_of.hpp"
#include "tests/tiles/store/map_fixture.hpp"
#include "tiles/store/map_verifier.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::ingest;
using testing::settings_37n;
using testing::some_blocks;
using testing::TemporaryFolder;

class MapFile : public ::testing::Test {
 protected:
  MapFile() : path(folder / "m.gpkg") {
    MapWriter writer(path, settings_37n());
    ingest(writer, {"a", 1, some_blocks(2)});
  }

  void execute(const char* sql) { testing::open_sqlite(path).execute(sql); }

  /// Code of the error that opening (and reading everything) ends in.
  std::string opened() const {
    try {
      const MapReader reader(path);
      for (const TileIndex tile : reader.tiles(0)) reader.tile(0, tile);
      return "whole";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path.string()));
      return error.code();
    }
  }

  TemporaryFolder folder;
  fs::path path;
};

TEST_F(MapFile, AMissingOneIsNotFound) {
  fs::remove(path);
  EXPECT_EQ(opened(), "map-not-found");
}

TEST_F(MapFile, OneThatCannotEvenBeLookedForSaysWhy) {
  path = folder / (std::string(300, 'm') + ".gpkg");
  EXPECT_EQ(opened(), "map-io");
  EXPECT_EQ(testing::code_of([&] { info_of(path); }), "map-io");
}

TEST_F(MapFile, AFolderIsNotOne) {
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_EQ(opened(), "map-not-ours");
}

TEST_F(MapFile, AnEmptyOneIsRefused) {
  fs::resize_file(path, 0);
  EXPECT_EQ(opened(), "map-empty-file");
  EXPECT_THROW(MapWriter(path, settings_37n()), CorruptData);
}

TEST_F(MapFile, AnythingElseIsNotOurs) {
  std::ofstream(path, std::ios::trunc) << "<html>" << std::string(5000, 'x');
  EXPECT_EQ(opened(), "map-not-ours");
}

TEST_F(MapFile, ADatabaseThatIsNoGeoPackageIsNotOurs) {
  execute("PRAGMA application_id = 7");
  EXPECT_EQ(opened(), "map-not-ours");
}

TEST_F(MapFile, AGeoPackageOfAnotherProgramIsNotOurs) {
  execute("DROP TABLE roadfix_meta");
  EXPECT_EQ(opened(), "map-not-ours");
  const fs::path elsewhere = folder / "my roads.gpkg";
  fs::rename(path, elsewhere);
  try {
    MapReader reader(elsewhere);
    FAIL() << "a map";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("roadfix ingest '" + elsewhere.string() + "' --map MAP.gpkg"));
  }
}

TEST_F(MapFile, OneOfAnotherVersionSaysSo) {
  execute("UPDATE roadfix_meta SET value = '3' WHERE key = 'schema_version'");
  EXPECT_EQ(opened(), "map-from-newer-version");
  execute("UPDATE roadfix_meta SET value = '1' WHERE key = 'schema_version'; DROP TABLE roadfix_shifts");
  EXPECT_EQ(opened(), "map-from-older-version");
  EXPECT_EQ(testing::code_of([&] { MapWriter(path, settings_37n()); }), "map-from-older-version");
}

TEST_F(MapFile, DamagedSettingsAreFound) {
  for (const char* sql :
       {"UPDATE roadfix_meta SET value = '3.5' WHERE key = 'cell_m'",
        "UPDATE roadfix_meta SET value = '4326' WHERE key = 'epsg'", "DELETE FROM roadfix_meta WHERE key = 'version'",
        "UPDATE roadfix_meta SET value = 'x' WHERE key = 'schema_version'", "UPDATE gpkg_contents SET max_x = 1e300",
        "UPDATE gpkg_contents SET max_y = min_y - 1", "UPDATE roadfix_sources SET kind = 'road'"}) {
    const auto whole = folder / "whole.gpkg";
    fs::copy_file(path, whole, fs::copy_options::overwrite_existing);
    execute(sql);
    EXPECT_EQ(opened(), "map-corrupt") << sql;
    fs::rename(whole, path);
  }
}

TEST_F(MapFile, ASettingThatTheTileLatticeContradictsIsFound) {
  for (const char* sql :
       {"UPDATE roadfix_meta SET value = '32636' WHERE key = 'epsg'",
        "UPDATE roadfix_meta SET value = '1' WHERE key = 'cell_m'",
        "UPDATE roadfix_meta SET value = '4' WHERE key = 'cell_m'", "UPDATE gpkg_tile_matrix_set SET srs_id = 32636",
        "UPDATE gpkg_tile_matrix SET pixel_y_size = 1 WHERE zoom_level = 11", "DELETE FROM gpkg_tile_matrix"}) {
    const auto whole = folder / "whole.gpkg";
    fs::copy_file(path, whole, fs::copy_options::overwrite_existing);
    execute(sql);
    EXPECT_EQ(opened(), "map-corrupt") << sql;
    EXPECT_EQ(testing::code_of([&] { info_of(path); }), "map-corrupt") << sql;
    EXPECT_FALSE(verify_map(path).problems.empty()) << sql;
    fs::rename(whole, path);
  }
}

TEST_F(MapFile, OneInWalModeSaysSoInAFolderThatMayNotBeWrittenTo) {
  execute("PRAGMA journal_mode = WAL");
  using fs::perms;
  constexpr perms kRead = perms::owner_read | perms::group_read | perms::others_read;
  fs::permissions(folder.path(), kRead | perms::owner_exec | perms::group_exec | perms::others_exec);
  const testing::AsAnotherUser other;
  if (other.may_do_everything()) GTEST_SKIP() << "there is no other user here";
  EXPECT_EQ(opened(), "map-in-wal-mode");
}

TEST_F(MapFile, AWriterTakesItOutOfWalModeUnlessSomebodyHasItOpen) {
  const auto in_wal_mode = [&] {
    auto map = testing::open_sqlite(path);
    sqlite::Statement mode(map, "PRAGMA journal_mode");
    return mode.step() && mode.text(0) == "wal";
  };
  execute("PRAGMA journal_mode = WAL");
  {
    auto open_elsewhere = testing::open_sqlite(path);
    open_elsewhere.execute("SELECT count(*) FROM gpkg_contents");
    MapWriter writer(path, settings_37n());
    ingest(writer, {"b", 2, some_blocks(1)});
    EXPECT_TRUE(in_wal_mode());
  }
  const MapWriter next(path, settings_37n());
  EXPECT_FALSE(in_wal_mode());
  EXPECT_EQ(opened(), "whole");
}

TEST_F(MapFile, ACutOffOneSaysSoWhereverItEnds) {
  const auto size = fs::file_size(path);
  for (const double share : {0.999, 0.7, 0.3, 0.05}) {
    fs::resize_file(path, static_cast<std::uintmax_t>(static_cast<double>(size) * share));
    EXPECT_EQ(opened(), "map-cut-off") << share;
  }
  fs::resize_file(path, 50);
  EXPECT_EQ(opened(), "map-cut-off");
}

TEST_F(MapFile, ACorruptTileIsNamed) {
  execute(
      "UPDATE road_probability SET tile_data = substr(tile_data, 1, 100) WHERE zoom_level = 11 AND tile_column = "
      "848");
  const MapReader reader(path);
  EXPECT_TRUE(reader.tile(0, {847, -8165}).has_value());
  try {
    reader.read(GridGeometry::covering(reader.info().extent, 2.0));
    FAIL();
  } catch (const CorruptData& error) {
    EXPECT_EQ(error.code(), "tile-corrupt");
    EXPECT_THAT(error.what(), HasSubstr("zoom 11 column 848 row 12315"));
  }
}

/// Copies the map as a writer leaves it that is killed in the middle of a transaction, its pages half written.
void copy_as_if_killed(const fs::path& map, const fs::path& copy) {
  sqlite::Connection writer = testing::open_sqlite(map);
  writer.execute("PRAGMA cache_size = 1");  // writes pages before the transaction ends
  writer.execute("BEGIN");
  writer.execute("UPDATE roadfix_meta SET value = 'half written'");
  writer.execute("UPDATE road_probability SET tile_data = zeroblob(50000)");
  fs::copy_file(map, copy);
  fs::copy_file(map.string() + "-journal", copy.string() + "-journal");
}

TEST_F(MapFile, AHalfWrittenOneIsPutBackWhenItIsOpened) {
  const auto expected = testing::tile_bytes(path);
  const auto version = MapReader(path).info().version;
  const auto copy = folder / "copy.gpkg";
  copy_as_if_killed(path, copy);
  EXPECT_EQ(MapReader(copy).info().version, version);
  EXPECT_EQ(testing::tile_bytes(copy), expected);
  EXPECT_FALSE(fs::exists(copy.string() + "-journal"));
}

TEST_F(MapFile, AWriterThatDiesDuringAReadIsUndone) {
  const auto copy = folder / "copy.gpkg";
  fs::copy_file(path, copy);
  const MapReader reader(copy);
  const auto killed = folder / "killed.gpkg";
  copy_as_if_killed(path, killed);
  // In place, so that the reader's descriptor sees it as it would see a dead writer's file.
  std::ofstream(copy, std::ios::binary | std::ios::in | std::ios::out)
      << std::ifstream(killed, std::ios::binary).rdbuf();
  fs::rename(killed.string() + "-journal", copy.string() + "-journal");
  for (const TileIndex tile : some_blocks(2)) EXPECT_EQ(reader.tile(0, tile), testing::random_cells(1, tile));
}

TEST_F(MapFile, ANewOneTakesNothingFromWhatADeletedOneLeft) {
  const auto copy = folder / "copy.gpkg";
  const auto expect_as_told = [&](const char* log) {
    SCOPED_TRACE(log);
    ASSERT_GT(fs::file_size(copy.string() + log), 0U);
    fs::remove(copy);
    {
      MapWriter writer(copy, {*UtmZone::from_epsg(32638), 1.0});
      ingest(writer, {"a", 1, some_blocks(1)});
    }
    EXPECT_EQ(MapReader(copy).info().settings.zone.epsg(), 32638);
    EXPECT_TRUE(verify_map(copy).problems.empty());
    fs::remove(copy);
  };
  copy_as_if_killed(path, copy);
  expect_as_told("-journal");
  execute("PRAGMA journal_mode = WAL");
  {
    sqlite::Connection open_elsewhere = testing::open_sqlite(path);
    open_elsewhere.execute("UPDATE road_probability SET tile_data = zeroblob(50000)");
    for (const char* part : {"", "-wal", "-shm"}) fs::copy_file(path.string() + part, copy.string() + part);
  }
  expect_as_told("-wal");
}

TEST_F(MapFile, GdalFindsItValid) {
  if (std::system("/usr/bin/python3 -c 'import osgeo_utils.samples.validate_gpkg' 2>/dev/null") != 0) {
    GTEST_SKIP() << "GDAL for Python is not installed (python3-gdal)";
  }
  const std::string command =
      "/usr/bin/python3 -m osgeo_utils.samples.validate_gpkg --extra --warning-as-error " + path.string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace roadfix
