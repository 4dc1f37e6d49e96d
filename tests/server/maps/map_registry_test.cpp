#include "server/maps/map_registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/units/error.hpp"
#include "tests/support/as_another_user.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/eventually.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix::server {
namespace {

namespace fs = std::filesystem;
using roadfix::testing::AsAnotherUser;
using roadfix::testing::CapturedLog;
using roadfix::testing::code_of;
using roadfix::testing::TemporaryFolder;

constexpr MapCacheBytes kCache{.tiles = std::size_t{1} << 20, .searches = 0};

void make_map(const fs::path& path, std::uint64_t seed, bool replace = false) {
  MapWriter writer(path, roadfix::testing::settings_37n());
  roadfix::testing::ingest(writer, {"imagery", seed, roadfix::testing::some_blocks(1)}, replace);
}

TEST(MapRegistry, NoticesMapsThatAppearChangeAndLeave) {
  const TemporaryFolder folder;
  MapRegistry registry(folder.path(), kCache);
  EXPECT_TRUE(registry.maps().empty());

  make_map(folder / "city.gpkg", 1);
  registry.refresh();
  const auto first = registry.find("city");
  EXPECT_EQ(first->name(), "city");

  make_map(folder / "city.gpkg", 2, true);
  registry.refresh();
  const auto second = registry.find("city");
  EXPECT_NE(second->view.id.version, first->view.id.version);
  EXPECT_EQ(code_of([&] { first->view.read(GridGeometry::covering(first->view.extent, 2.0)); }), "map-renewed")
      << "requests under way mix no tiles of the two";

  fs::remove(folder / "city.gpkg");
  registry.refresh();
  EXPECT_THROW(registry.find("city"), NotFound);
}

TEST(MapRegistry, TellsOfEachMapThatItServesFromNowOn) {
  const TemporaryFolder folder;
  make_map(folder / "there.gpkg", 1);
  std::vector<std::string> told;
  MapRegistry registry(folder.path(), kCache, [&](const ServedMap& map) { told.push_back(map.name()); });
  EXPECT_EQ(told, std::vector<std::string>{"there"});
  make_map(folder / "later.gpkg", 1);
  make_map(folder / "there.gpkg", 2, true);
  registry.refresh();
  registry.refresh();
  EXPECT_EQ(told, (std::vector<std::string>{"there", "later", "there"}));
}

TEST(MapRegistry, KeepsTheReaderOfAFileThatWasOnlyTouched) {
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  MapRegistry registry(folder.path(), kCache);
  const auto before = registry.find("city");
  fs::last_write_time(folder / "city.gpkg", fs::file_time_type::clock::now() + std::chrono::seconds(5));
  registry.refresh();
  EXPECT_EQ(registry.find("city"), before);
}

TEST(MapRegistry, NoticesAFileIntoWhichOneOfTheSameSizeAndDateWasCopied) {
  const TemporaryFolder folder;
  const fs::path path = folder / "city.gpkg";
  const fs::path other = folder / "other";
  make_map(path, 1);
  fs::copy_file(path, other);
  roadfix::testing::open_sqlite(other).execute(
      "UPDATE roadfix_meta SET value = '0123456789abcdef' WHERE key = 'version'");
  ASSERT_EQ(fs::file_size(other), fs::file_size(path));
  MapRegistry registry(folder.path(), kCache);
  const fs::file_time_type date = fs::last_write_time(path);
  fs::copy_file(other, path, fs::copy_options::overwrite_existing);
  fs::last_write_time(path, date);
  registry.refresh();
  EXPECT_EQ(registry.find("city")->view.id.version, "0123456789abcdef");
}

TEST(MapRegistry, KeepsAMapThatAWriterHasLockedAsItWasAndItsReadersWaitOnlyASecond) {
  using Clock = std::chrono::steady_clock;
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  MapRegistry registry(folder.path(), kCache);
  const auto city = registry.find("city");
  {
    sqlite::Connection writer = roadfix::testing::open_sqlite(folder / "city.gpkg");
    writer.execute("BEGIN EXCLUSIVE");
    fs::last_write_time(folder / "city.gpkg", fs::file_time_type::clock::now() + std::chrono::seconds(5));
    const Clock::time_point start = Clock::now();
    registry.refresh();
    EXPECT_EQ(registry.find("city"), city);
    EXPECT_EQ(code_of([&] { city->view.read(GridGeometry::covering(city->view.extent, 2.0)); }), "map-busy");
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(30));
    writer.execute("UPDATE roadfix_meta SET value = '0123456789abcdef' WHERE key = 'version'; COMMIT");
  }
  registry.refresh();
  EXPECT_EQ(registry.find("city")->view.id.version, "0123456789abcdef") << "the next look sees what was written";
  EXPECT_NO_THROW(registry.find("city")->view.read(GridGeometry::covering(city->view.extent, 2.0)));
}

TEST(MapRegistry, KeepsNothingOfAVersionThatCameAndWentBetweenTwoLooks) {
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  MapRegistry registry(folder.path(), kCache);
  const auto city = registry.find("city");
  const TileIndex block = roadfix::testing::some_blocks(1).front();
  const auto cells = [&] { return city->reader->tile(0, block); };
  {
    MapWriter writer(folder / "city.gpkg", roadfix::testing::settings_37n());
    roadfix::testing::ingest(writer, {"roads", 2, roadfix::testing::some_blocks(1)});
    EXPECT_EQ(code_of(cells), "map-renewed");
    writer.remove_source("roads");
  }
  registry.refresh();
  ASSERT_EQ(registry.find("city"), city) << "it says the same as before";
  EXPECT_EQ(cells(), roadfix::testing::random_cells(1, block));
}

TEST(MapRegistry, AsksToComeBackForAMapThatIsLockedWhenItAppears) {
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  sqlite::Connection writer = roadfix::testing::open_sqlite(folder / "city.gpkg");
  writer.execute("BEGIN EXCLUSIVE");
  MapRegistry registry(folder.path(), kCache);
  EXPECT_EQ(code_of([&] { registry.find("city"); }), "map-busy");
  writer.execute("ROLLBACK");
  registry.refresh();
  EXPECT_EQ(registry.find("city")->name(), "city");
}

TEST(MapRegistry, LogsWhichMapsLackBlocksOfAnIngestThatWasInterrupted) {
  const TemporaryFolder folder;
  make_map(folder / "whole.gpkg", 1);
  make_map(folder / "half.gpkg", 1);
  {
    MapWriter writer(folder / "half.gpkg", roadfix::testing::settings_37n());
    const roadfix::testing::TestSource post{"post", 2, roadfix::testing::some_blocks(2)};
    const auto blocks = writer.begin_source(post.record(), post.blocks, false);
    roadfix::testing::put_block(writer, "post", blocks.front(), roadfix::testing::random_cells(2, blocks.front()));
  }
  const CapturedLog log;
  const MapRegistry registry(folder.path(), kCache);
  EXPECT_EQ(log.count("lacks what an ingest"), 1);
  EXPECT_EQ(log.count("map half lacks what an ingest has not brought yet (source 'post': 1 of 4 blocks)"), 1);
}

TEST(MapRegistry, LogsThatItsFolderHoldsNoMapYet) {
  const TemporaryFolder folder;
  const std::ofstream imagery(folder / "imagery.tif");
  const CapturedLog log;
  const MapRegistry registry(folder.path(), kCache);
  EXPECT_EQ(log.count("no map (*.gpkg) is in " + folder.path().string() + " yet"), 1);
}

TEST(MapRegistry, NoticesThatASourceIsDescribedOtherwiseThoughItsCellsAreTheSame) {
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  MapRegistry registry(folder.path(), kCache);
  ASSERT_EQ(registry.find("city")->view.registration_sigma_m({}), 2.5);
  {
    MapWriter writer(folder / "city.gpkg", roadfix::testing::settings_37n());
    SourceRecord record = registry.find("city")->reader->info().sources.front().record;
    record.provenance.registration_sigma_m = 12.0;
    const auto blocks = roadfix::testing::some_blocks(1);
    ASSERT_TRUE(writer.begin_source(record, blocks, false).empty()) << "nothing is to be done but to describe it";
  }
  registry.refresh();
  EXPECT_EQ(registry.find("city")->view.registration_sigma_m({}), 12.0) << "else ellipses stay too small";
}

TEST(MapRegistry, NoticesThatASourceLiesBesideTheOthers) {
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  MapRegistry registry(folder.path(), kCache);
  {
    MapWriter writer(folder / "city.gpkg", roadfix::testing::settings_37n());
    const std::string source = registry.find("city")->reader->info().sources.front().record.name;
    writer.put_shifts({{source, SourceShift{.east_m = 24.0, .sigma_m = 12.0}}});
  }
  registry.refresh();
  EXPECT_EQ(registry.find("city")->view.registration_sigma_m({}), 12.0);
}

TEST(MapRegistry, NoticesThatTheHeightsOfTheGroundCameChangedOrWent) {
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  MapRegistry registry(folder.path(), kCache);
  const auto before = registry.find("city");
  EXPECT_EQ(before->view.terrain, nullptr);
  const auto height = [&] {
    registry.refresh();
    const auto map = registry.find("city");
    EXPECT_EQ(map->view.id.version, before->view.id.version);
    return map->view.terrain ? map->view.terrain->cell_height_m(0, 0) : std::nullopt;
  };
  MapWriter writer(folder / "city.gpkg", roadfix::testing::settings_37n());
  for (const double height_m : {600.0, 700.0}) {
    writer.put_terrain({{32.0, {13'552, -130'640}, 1, 1}, {Terrain::code_of(height_m)}}, {.location = "heights.tif"});
    ASSERT_TRUE(height()) << height_m;
    EXPECT_NEAR(*height(), height_m, 0.1);
  }
  writer.remove_terrain();
  EXPECT_FALSE(height());
}

TEST(MapRegistry, ServesTheOthersWhenOneIsBrokenAndSaysWhy) {
  const TemporaryFolder folder;
  make_map(folder / "good.gpkg", 1);
  std::ofstream(folder / "broken.gpkg") << "this is no map";
  std::ofstream(folder / "empty.gpkg").flush();
  std::ofstream(folder / "notes.txt") << "not looked at";
  MapRegistry registry(folder.path(), kCache);
  EXPECT_EQ(registry.maps().size(), 1U);
  const auto broken = registry.unreadable();
  ASSERT_EQ(broken.size(), 2U);
  EXPECT_EQ(broken[0].name, "broken");
  EXPECT_FALSE(broken[0].reason.empty());
  EXPECT_FALSE(broken[0].code.empty());
  EXPECT_THROW(registry.find("broken"), IoFailure);

  fs::remove(folder / "broken.gpkg");
  make_map(folder / "broken.gpkg", 3);
  registry.refresh();
  EXPECT_EQ(registry.find("broken")->name(), "broken") << "a repaired map is served";
}

TEST(MapRegistry, TakesNoHiddenFileForAMap) {
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  fs::copy(folder / "city.gpkg", folder / ".copied.gpkg");
  std::ofstream(folder / "._city.gpkg") << "what a Mac keeps beside a file";
  const MapRegistry registry(folder.path(), kCache);
  EXPECT_EQ(registry.maps().size(), 1U);
  EXPECT_TRUE(registry.unreadable().empty());
}

TEST(MapRegistry, TakesTheExtensionInAnyCaseAndOfTwoTheUsualOneAndLogsTheOtherOnce) {
  const TemporaryFolder folder;
  make_map(folder / "CITY.GPKG", 1);
  make_map(folder / "town.Gpkg", 2);
  MapRegistry registry(folder.path(), kCache);
  EXPECT_NE(registry.find("CITY"), nullptr);
  EXPECT_EQ(registry.maps().size(), 2U);
  make_map(folder / "town.gpkg", 3);
  const CapturedLog log;
  for (int look = 0; look < 3; ++look) registry.refresh();
  EXPECT_EQ(log.count("is not served: another file"), 1);
  EXPECT_EQ(log.count((folder / "town.Gpkg").string() + " is not served"), 1);
  EXPECT_EQ(registry.find("town")->view.id.version, MapReader(folder / "town.gpkg").info().version);
  EXPECT_EQ(registry.maps().size(), 2U);
}

TEST(MapRegistry, SaysThatALinkLeadsNowhere) {
  const TemporaryFolder folder;
  const TemporaryFolder disk;
  fs::create_symlink(disk / "city.gpkg", folder / "city.gpkg");
  fs::create_directory(folder / "folder.gpkg");
  fs::create_symlink(folder / "folder.gpkg", folder / "link.gpkg");
  MapRegistry registry(folder.path(), kCache);
  ASSERT_EQ(registry.unreadable().size(), 1U);
  EXPECT_EQ(registry.unreadable()[0].name, "city");
  EXPECT_NE(registry.unreadable()[0].reason.find("a link to a file that is not there"), std::string::npos);
  make_map(disk / "city.gpkg", 1);
  registry.refresh();
  EXPECT_EQ(registry.find("city")->name(), "city") << "its disk is there by now";
}

TEST(MapRegistry, ServesAMapOnceItMayReadIt) {
  const TemporaryFolder folder;
  make_map(folder / "city.gpkg", 1);
  fs::permissions(folder.path(), fs::perms{0755});
  fs::permissions(folder / "city.gpkg", fs::perms::none);
  std::optional<MapRegistry> registry;
  {
    const AsAnotherUser reader;
    if (reader.may_do_everything()) GTEST_SKIP();
    registry.emplace(folder.path(), kCache);
  }
  ASSERT_EQ(registry->unreadable().size(), 1U);
  fs::permissions(folder / "city.gpkg", fs::perms{0644});
  const AsAnotherUser reader;
  registry->refresh();
  EXPECT_EQ(registry->maps().size(), 1U) << "though nothing was written to it";
  EXPECT_TRUE(registry->unreadable().empty());
}

TEST(MapRegistry, WatchesByItself) {
  const TemporaryFolder folder;
  MapRegistry registry(folder.path(), kCache);
  registry.watch(std::chrono::milliseconds(5));
  make_map(folder / "city.gpkg", 1);
  EXPECT_TRUE(testing::eventually([&] { return registry.maps().size() == 1; }));
}

TEST(MapRegistry, ComplainsOnceWhileItsFolderCannotBeRead) {
  using std::chrono::milliseconds;
  const TemporaryFolder folder;
  fs::create_directory(folder / "maps");
  const CapturedLog log;
  {
    MapRegistry registry(folder / "maps", kCache);
    registry.watch(milliseconds(2));
    fs::rename(folder / "maps", folder / "away");
    EXPECT_TRUE(testing::eventually([&] { return log.count("cannot be read") > 0; }));
    std::this_thread::sleep_for(milliseconds(50));
    fs::rename(folder / "away", folder / "maps");
    EXPECT_TRUE(testing::eventually([&] { return log.count("can be read again") > 0; }));
  }
  EXPECT_EQ(log.count("cannot be read"), 1) << "a folder that stays away for a night is no night of messages";
  EXPECT_EQ(log.count("can be read again"), 1);
}

TEST(MapRegistry, SaysWhyItsFolderCannotBeReadAndServesWhatItHas) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "maps");
  make_map(folder / "maps" / "city.gpkg", 1);
  MapRegistry registry(folder / "maps", kCache);
  EXPECT_FALSE(registry.problem());
  fs::rename(folder / "maps", folder / "away");
  EXPECT_EQ(code_of([&] { registry.refresh(); }), "maps-folder-unreadable");
  EXPECT_THAT(registry.problem(), ::testing::Optional(::testing::HasSubstr((folder / "maps").string())));
  EXPECT_EQ(registry.maps().size(), 1U);
  fs::rename(folder / "away", folder / "maps");
  registry.refresh();
  EXPECT_FALSE(registry.problem());
}

TEST(MapRegistry, SaysOfAFolderThatItMayNotReadThatItMayNot) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "srv" / "maps");
  fs::permissions(folder.path(), fs::perms{0755});
  for (const fs::path& closed : {folder / "srv" / "maps", folder / "srv"}) {
    fs::permissions(closed, fs::perms{0700});
    const AsAnotherUser reader;
    if (reader.may_do_everything()) GTEST_SKIP();
    try {
      const MapRegistry registry(folder / "srv" / "maps", kCache);
      ADD_FAILURE() << closed << " was read";
    } catch (const IoFailure& error) {
      EXPECT_EQ(error.code(), "maps-folder-unreadable");
      EXPECT_NE(std::string(error.what()).find("Permission denied"), std::string::npos) << error.what();
    }
  }
}

TEST(MapRegistry, RefusesAFolderThatIsNotThere) {
  EXPECT_EQ(code_of([] { MapRegistry("/no/such/folder", kCache); }), "maps-folder-not-found");
}

}  // namespace
}  // namespace roadfix::server
