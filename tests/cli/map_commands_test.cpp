// roadfix info, verify, remove and export as a script meets them: exit codes, JSON on stdout, one line on stderr.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/map_commands_fixture.hpp"
#include "tests/support/room.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using testing::ingest;
using testing::MapCommands;
using ::testing::Not;
using testing::ProgramResult;
using testing::settings_37n;
using testing::some_blocks;

TEST_F(MapCommands, InfoTellsWhatTheMapHolds) {
  const ProgramResult text = roadfix("info " + map);
  EXPECT_EQ(text.code, 0);
  EXPECT_THAT(text.out, HasSubstr("EPSG:32637, cells of 2 m"));
  EXPECT_THAT(text.out, HasSubstr("CC BY 4.0"));
  const auto json = nlohmann::json::parse(roadfix("info --json " + map).out);
  EXPECT_EQ(json["epsg"], 32637);
  EXPECT_EQ(json["tiles"], 4);
  EXPECT_EQ(json["status"], "ready");
  EXPECT_EQ(json["sources"][0]["name"], "a");
  const std::vector<double> bbox = json["bbox"];
  EXPECT_NEAR(bbox[1], 37.76, 0.01);
  const std::vector<double> extent = json["extent_m"];
  for (const GridPoint corner : {GridPoint{extent[0], extent[1]}, GridPoint{extent[0], extent[3]},
                                 GridPoint{extent[2], extent[1]}, GridPoint{extent[2], extent[3]}}) {
    const LatLon place = settings_37n().zone.unproject(corner);
    EXPECT_TRUE(place.lon_deg >= bbox[0] && place.lon_deg <= bbox[2]) << place.lon_deg;
    EXPECT_TRUE(place.lat_deg >= bbox[1] && place.lat_deg <= bbox[3]) << place.lat_deg;
  }
}

TEST_F(MapCommands, AMapOfAnIngestThatWasKilledBetweenBlocksIsIncompleteAndSaysSo) {
  {
    MapWriter writer(map, settings_37n());
    const testing::TestSource post{"post", 2, some_blocks(2)};
    const auto blocks = writer.begin_source(post.record(), post.blocks, false);
    testing::put_block(writer, "post", blocks.front(), testing::random_cells(2, blocks.front()));
  }
  EXPECT_EQ(nlohmann::json::parse(roadfix("info --json " + map).out)["status"], "incomplete");
  const ProgramResult result = roadfix("export " + map + " " + (folder / "out.tif").string());
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("(source 'post': 1 of 4 blocks)"));
}

TEST_F(MapCommands, VerifyEndsWithOneForADamagedMap) {
  EXPECT_EQ(roadfix("verify " + map).code, 0);
  testing::open_sqlite(map).execute("UPDATE road_probability SET tile_data = x'00' WHERE zoom_level = 4");
  const ProgramResult damaged = roadfix("verify --json " + map);
  EXPECT_EQ(damaged.code, 1);
  EXPECT_EQ(nlohmann::json::parse(damaged.out)["problems"][0]["code"], "tile-corrupt");
  EXPECT_THAT(damaged.err, HasSubstr("[map-damaged]"));
  EXPECT_EQ(roadfix("verify --repair " + map).code, 0);
  EXPECT_EQ(roadfix("verify " + map).code, 0);
}

TEST_F(MapCommands, InfoSaysWhatARepairLost) {
  testing::open_sqlite(map).execute("UPDATE roadfix_evidence SET tile_data = x'00' WHERE id = 1");
  EXPECT_EQ(roadfix("verify --repair " + map).code, 1);
  EXPECT_THAT(roadfix("info " + map).out, HasSubstr("damaged: 1 of "));
}

TEST_F(MapCommands, VerifySaysThatAMapIsEmpty) {
  const auto empty = folder / "empty.gpkg";
  { const MapWriter made(empty, settings_37n()); }
  const ProgramResult result = roadfix("verify " + empty.string());
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("no ground is observed yet"));
  EXPECT_THAT(roadfix("verify " + map).out, Not(HasSubstr("empty")));
}

TEST_F(MapCommands, RemoveLeavesTheMapOfTheOtherSources) {
  const auto before = testing::tile_bytes(map);
  {
    MapWriter writer(map, settings_37n());
    ingest(writer, {"b", 2, some_blocks(2, 1)});
  }
  EXPECT_NE(testing::tile_bytes(map), before);
  EXPECT_EQ(roadfix("remove " + map + " b").code, 0);
  EXPECT_EQ(testing::tile_bytes(map), before);
  const ProgramResult again = roadfix("remove " + map + " b");
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, HasSubstr("[source-not-found]"));
  EXPECT_EQ(roadfix("verify " + map).code, 0);
}

TEST_F(MapCommands, RemoveSaysThatItDidAndWhichEvidenceOfOtherSourcesIsDamaged) {
  {
    MapWriter writer(map, settings_37n());
    ingest(writer, {"b", 2, some_blocks(2)});
    ingest(writer, {"far", 3, some_blocks(1, 9)});
  }
  testing::open_sqlite(map).execute(
      "UPDATE roadfix_evidence SET tile_data = zeroblob(50) WHERE source_id = (SELECT id FROM roadfix_sources WHERE "
      "name = 'b')");
  const ProgramResult result = roadfix("remove " + map + " far");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("source 'far' is removed"));
  EXPECT_THAT(result.err, HasSubstr("evidence of source 'b' column 847 row"));
}

TEST_F(MapCommands, ExportWritesARegion) {
  const auto target = folder / "out.tif";
  const std::string arguments = map + " " + target.string();
  EXPECT_EQ(roadfix("export " + arguments + " --bbox 38.248 37.765 38.25 37.767 --cell 4").code, 0);
  EXPECT_TRUE(std::filesystem::exists(target));
  for (const char* elsewhere : {"39 37 39.1 37.1", "100 37 120 40"}) {
    const ProgramResult result = roadfix("export " + arguments + " --bbox " + elsewhere);
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.err, HasSubstr("[region-outside-map]"));
  }
  EXPECT_EQ(roadfix("export " + arguments + " --bbox 0 0 90 80 --cell 4").code, 0) << "reaches beyond the UTM zone";
  const ProgramResult across = roadfix("export " + arguments + " --bbox 179,37,-179,38");
  EXPECT_THAT(across.err, HasSubstr("[region-outside-map]")) << "the antimeridian is not on this map";
  EXPECT_EQ(roadfix("export " + arguments + " --bbox 38.25,37,38.24,38").code, 2) << "west above east";
}

TEST_F(MapCommands, SayThatTilesStillShowWhatTheMapHeldBefore) {
  EXPECT_THAT(roadfix("export " + map + " " + (folder / "before.tif").string()).err, Not(HasSubstr("still show")));
  testing::open_sqlite(map).execute("INSERT INTO roadfix_pending VALUES (11, 12315, 848)");
  const ProgramResult exported = roadfix("export " + map + " " + (folder / "after.tif").string());
  EXPECT_EQ(exported.code, 0);
  EXPECT_THAT(exported.err, HasSubstr("note: " + map + ": 1 of its tiles still show"));
  EXPECT_THAT(roadfix("fix " + map + " nowhere.png --cell 2").err, HasSubstr("still show"));
  EXPECT_THAT(roadfix("match " + map + " nowhere.png --cell 2 --pose 37.76,38.25,0").err, HasSubstr("still show"));
}

TEST_F(MapCommands, ExportTakesTheFormatFromTheNameOfItsTarget) {
  const auto begin_of = [&](const std::string& name, const std::string& more) {
    const ProgramResult result = roadfix("export " + map + " " + (folder / name).string() + " --cell 8 " + more);
    EXPECT_EQ(result.code, 0) << result.err;
    std::string begin(4, ' ');
    std::ifstream(folder / name, std::ios::binary).read(begin.data(), 4);
    return begin;
  };
  EXPECT_EQ(begin_of("a.TIF", "--bbox 38.248,37.765,38.25,37.767"), "II*" + std::string(1, '\0'));
  EXPECT_EQ(begin_of("a.png", ""), "\x89PNG");
  EXPECT_EQ(begin_of("a.mbtiles", ""), "SQLi");
  EXPECT_EQ(begin_of("a.out", "--format png"), "\x89PNG");
  EXPECT_THAT(roadfix("export " + map + " a.jpg").err, HasSubstr("[export-format-unknown]"));
  EXPECT_EQ(roadfix("export " + map + " a.tif --format jpg").code, 2);
  for (const std::string& target : {std::string("-"), std::string("/dev/null"), folder.path().string()}) {
    EXPECT_THAT(roadfix("export " + map + " " + target + " --format png").err, HasSubstr("[target-not-file]"));
  }
  EXPECT_THAT(roadfix("export " + map + " " + map + " --format png").err, HasSubstr("[target-is-source]"));
}

TEST_F(MapCommands, FailureIsOneLineAndWrongUsageIsTwo) {
  for (const char* command : {"info", "verify", "export", "remove"}) {
    const std::string name = command;
    const std::string rest = name == "export" ? " x.tif" : name == "remove" ? " a" : "";
    const ProgramResult missing = roadfix(name + " no-such-map.gpkg" + rest);
    EXPECT_EQ(missing.code, 1);
    EXPECT_EQ(missing.err, "roadfix: no-such-map.gpkg: no such file [map-not-found]\n");
    EXPECT_EQ(roadfix(name).code, 2);
    EXPECT_THAT(roadfix(name + " --help").out, HasSubstr("Example"));
  }
}

TEST_F(MapCommands, AnAnswerThatFindsNoRoomIsAFailure) {
  const std::string err = folder / "err";
  const int status = std::system((ROADFIX_PROGRAM " info " + map + " >/dev/full 2>" + err).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(testing::text_of(err), HasSubstr("[output-unwritable]"));
}

TEST_F(MapCommands, SayThatAFileMayNotGrowAnyMoreWhereTheProcessWouldBeKilled) {
  const auto before = testing::tile_bytes(map);
  const testing::Room room(8192);
  signal(SIGXFSZ, SIG_DFL);  // as a shell leaves it
  const ProgramResult full = roadfix("remove " + map + " a");
  EXPECT_EQ(full.code, 1);
  EXPECT_THAT(full.err, HasSubstr("File too large [map-io]"));
  EXPECT_EQ(testing::tile_bytes(map), before);
}

TEST_F(MapCommands, FailAsTheyWouldWhereNobodyCanBeToldWhy) {
  const int status = std::system(ROADFIX_PROGRAM " info no-such-map.gpkg 2>/dev/full");
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

TEST_F(MapCommands, AMistypedSubcommandIsNamed) {
  const ProgramResult mistyped = roadfix("ingset a.tif --map " + map);
  EXPECT_EQ(mistyped.code, 2);
  EXPECT_THAT(mistyped.err, HasSubstr("no subcommand 'ingset'"));
  EXPECT_THAT(roadfix("").err, HasSubstr("A subcommand is required"));
  EXPECT_THAT(roadfix("info").err, HasSubstr("map is required"));
  EXPECT_THAT(roadfix("info " + map + " --jsn").err, HasSubstr("--jsn"));
}

}  // namespace
}  // namespace roadfix
