// roadfix info, verify and export as a script meets them: exit codes, JSON on stdout, one line on stderr.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/room.hpp"
#include "tests/support/run_program.hpp"
#include "tests/tiles/store/map_fixture.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using testing::ingest;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;
using testing::settings_37n;
using testing::some_blocks;
using testing::TemporaryFolder;

class MapCommands : public ::testing::Test {
 protected:
  MapCommands() : path(folder / "m.gpkg") {
    MapWriter writer(path, settings_37n());
    ingest(writer, {"a", 1, some_blocks(2)});
  }

  ProgramResult roadfix(const std::string& arguments) const { return run_program(folder.path(), arguments); }

  TemporaryFolder folder;
  std::filesystem::path path;
};

TEST_F(MapCommands, InfoTellsWhatTheMapHolds) {
  const ProgramResult text = roadfix("info " + path.string());
  EXPECT_EQ(text.code, 0);
  EXPECT_THAT(text.out, HasSubstr("EPSG:32637, cells of 2 m"));
  EXPECT_THAT(text.out, HasSubstr("CC BY 4.0"));
  const auto json = nlohmann::json::parse(roadfix("info --json " + path.string()).out);
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
    MapWriter writer(path, settings_37n());
    const testing::TestSource post{"post", 2, some_blocks(2)};
    const auto blocks = writer.begin_source(post.record(), post.blocks, false);
    testing::put_block(writer, "post", blocks.front(), testing::random_cells(2, blocks.front()));
  }
  EXPECT_EQ(nlohmann::json::parse(roadfix("info --json " + path.string()).out)["status"], "incomplete");
  const ProgramResult result = roadfix("export " + path.string() + " " + (folder / "out.tif").string());
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("(source 'post': 1 of 4 blocks)"));
}

TEST_F(MapCommands, AnswersInJsonOfFilesWhoseNamesAreNoUtf8) {
  const std::string source = folder / "m\xfc.tif";
  ASSERT_EQ(roadfix("export " + path.string() + " '" + source + "'").code, 0);
  const std::string target = folder / "n.gpkg";
  const ProgramResult result = roadfix("ingest '" + source + "' --as roads --json --map " + target);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["source"], "m\xef\xbf\xbd");
}

TEST_F(MapCommands, IngestOfWhatIsNeitherImageryNorRoadsIsWrongUsage) {
  const std::string into = " --map " + (folder / "n.gpkg").string();
  EXPECT_EQ(roadfix("ingest " + path.string() + " --as heights" + into).code, 2);
  EXPECT_EQ(roadfix("ingest " + path.string() + " --as auto" + into).code, 0);
}

TEST_F(MapCommands, VerifyEndsWithOneForADamagedMap) {
  EXPECT_EQ(roadfix("verify " + path.string()).code, 0);
  testing::open_sqlite(path).execute("UPDATE road_probability SET tile_data = x'00' WHERE zoom_level = 4");
  const ProgramResult damaged = roadfix("verify --json " + path.string());
  EXPECT_EQ(damaged.code, 1);
  EXPECT_EQ(nlohmann::json::parse(damaged.out)["problems"][0]["code"], "tile-corrupt");
  EXPECT_THAT(damaged.err, HasSubstr("[map-damaged]"));
  EXPECT_EQ(roadfix("verify --repair " + path.string()).code, 0);
  EXPECT_EQ(roadfix("verify " + path.string()).code, 0);
}

TEST_F(MapCommands, InfoSaysWhatARepairLost) {
  testing::open_sqlite(path).execute("UPDATE roadfix_evidence SET tile_data = x'00' WHERE id = 1");
  EXPECT_EQ(roadfix("verify --repair " + path.string()).code, 1);
  EXPECT_THAT(roadfix("info " + path.string()).out, HasSubstr("damaged: 1 of "));
}

TEST_F(MapCommands, VerifySaysThatAMapIsEmpty) {
  const auto empty = folder / "empty.gpkg";
  { const MapWriter made(empty, settings_37n()); }
  const ProgramResult result = roadfix("verify " + empty.string());
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("no ground is observed yet"));
  EXPECT_THAT(roadfix("verify " + path.string()).out, Not(HasSubstr("empty")));
}

TEST_F(MapCommands, RemoveLeavesTheMapOfTheOtherSources) {
  const auto before = testing::tile_bytes(path);
  {
    MapWriter writer(path, settings_37n());
    ingest(writer, {"b", 2, some_blocks(2, 1)});
  }
  EXPECT_NE(testing::tile_bytes(path), before);
  EXPECT_EQ(roadfix("remove " + path.string() + " b").code, 0);
  EXPECT_EQ(testing::tile_bytes(path), before);
  const ProgramResult again = roadfix("remove " + path.string() + " b");
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, HasSubstr("[source-not-found]"));
  EXPECT_EQ(roadfix("verify " + path.string()).code, 0);
}

TEST_F(MapCommands, RemoveSaysThatItDidAndWhichEvidenceOfOtherSourcesIsDamaged) {
  {
    MapWriter writer(path, settings_37n());
    ingest(writer, {"b", 2, some_blocks(2)});
    ingest(writer, {"far", 3, some_blocks(1, 9)});
  }
  testing::open_sqlite(path).execute(
      "UPDATE roadfix_evidence SET tile_data = zeroblob(50) WHERE source_id = (SELECT id FROM roadfix_sources WHERE "
      "name "
      "= 'b')");
  const ProgramResult result = roadfix("remove " + path.string() + " far");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("source 'far' is removed"));
  EXPECT_THAT(result.err, HasSubstr("evidence of source 'b' column 847 row"));
}

TEST_F(MapCommands, ExportWritesARegion) {
  const auto target = folder / "out.tif";
  const std::string arguments = path.string() + " " + target.string();
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
  EXPECT_THAT(roadfix("export " + path.string() + " " + (folder / "before.tif").string()).err,
              Not(HasSubstr("still show")));
  testing::open_sqlite(path).execute("INSERT INTO roadfix_pending VALUES (11, 12315, 848)");
  const ProgramResult exported = roadfix("export " + path.string() + " " + (folder / "after.tif").string());
  EXPECT_EQ(exported.code, 0);
  EXPECT_THAT(exported.err, HasSubstr("note: " + path.string() + ": 1 of its tiles still show"));
  EXPECT_THAT(roadfix("fix " + path.string() + " nowhere.png --cell 2").err, HasSubstr("still show"));
  EXPECT_THAT(roadfix("match " + path.string() + " nowhere.png --cell 2 --pose 37.76,38.25,0").err,
              HasSubstr("still show"));
}

TEST_F(MapCommands, ExportTakesTheFormatFromTheNameOfItsTarget) {
  const auto begin_of = [&](const std::string& name, const std::string& more) {
    const ProgramResult result =
        roadfix("export " + path.string() + " " + (folder / name).string() + " --cell 8 " + more);
    EXPECT_EQ(result.code, 0) << result.err;
    std::string begin(4, ' ');
    std::ifstream(folder / name, std::ios::binary).read(begin.data(), 4);
    return begin;
  };
  EXPECT_EQ(begin_of("a.TIF", "--bbox 38.248,37.765,38.25,37.767"), "II*" + std::string(1, '\0'));
  EXPECT_EQ(begin_of("a.png", ""), "\x89PNG");
  EXPECT_EQ(begin_of("a.mbtiles", ""), "SQLi");
  EXPECT_EQ(begin_of("a.out", "--format png"), "\x89PNG");
  EXPECT_THAT(roadfix("export " + path.string() + " a.jpg").err, HasSubstr("[export-format-unknown]"));
  EXPECT_EQ(roadfix("export " + path.string() + " a.tif --format jpg").code, 2);
  for (const std::string& target : {std::string("-"), std::string("/dev/null"), folder.path().string()}) {
    EXPECT_THAT(roadfix("export " + path.string() + " " + target + " --format png").err,
                HasSubstr("[target-not-file]"));
  }
  EXPECT_THAT(roadfix("export " + path.string() + " " + path.string() + " --format png").err,
              HasSubstr("[target-is-source]"));
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
  const int status = std::system((ROADFIX_PROGRAM " info " + path.string() + " >/dev/full 2>" + err).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(testing::text_of(err), HasSubstr("[output-unwritable]"));
}

TEST_F(MapCommands, SayThatAFileMayNotGrowAnyMoreWhereTheProcessWouldBeKilled) {
  const auto before = testing::tile_bytes(path);
  const testing::Room room(8192);
  signal(SIGXFSZ, SIG_DFL);  // as a shell leaves it
  const ProgramResult full = roadfix("remove " + path.string() + " a");
  EXPECT_EQ(full.code, 1);
  EXPECT_THAT(full.err, HasSubstr("File too large [map-io]"));
  EXPECT_EQ(testing::tile_bytes(path), before);
}

TEST_F(MapCommands, FailAsTheyWouldWhereNobodyCanBeToldWhy) {
  const int status = std::system(ROADFIX_PROGRAM " info no-such-map.gpkg 2>/dev/full");
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

TEST_F(MapCommands, AMapIsNoSourceOfItself) {
  const auto before = testing::tile_bytes(path);
  const std::string as_roads = " --as roads --name again --map " + path.string();
  const ProgramResult result = roadfix("ingest " + path.string() + as_roads);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("[source-is-target]"));
  EXPECT_THAT(roadfix("ingest " + folder.path().string() + as_roads).err, HasSubstr("[source-empty]"));
  std::ofstream(folder / "roads.geojson") << R"({"type": "LineString", "coordinates": [[38.2, 37.7], [38.21, 37.71]]})";
  const ProgramResult beside = roadfix("ingest " + folder.path().string() + as_roads + " --dry-run");
  EXPECT_EQ(beside.code, 0) << beside.err;
  EXPECT_THAT(beside.err, Not(HasSubstr("left out")));
  EXPECT_EQ(testing::tile_bytes(path), before);
}

TEST_F(MapCommands, AMapHasAName) {
  EXPECT_THAT(roadfix("ingest " + path.string() + " --map -").err, HasSubstr("[target-is-dash]"));
}

TEST_F(MapCommands, IngestTakesOutWhatWasToldOfASource) {
  const std::string lines = folder / "roads.geojson";
  std::ofstream(lines) << R"({"type": "LineString", "coordinates": [[38.2, 37.7], [38.21, 37.71]]})";
  const std::string map = folder / "n.gpkg";
  const std::string ingest = "ingest " + lines + " --map " + map;
  ASSERT_EQ(roadfix(ingest + " --licence ODbL --date 2023").code, 0);
  const ProgramResult again = roadfix(ingest + " --licence ''");
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err, HasSubstr("'roads' now has licence none instead of 'ODbL'"));
  EXPECT_THAT(roadfix("info " + map).out, ::testing::AllOf(HasSubstr("2023"), Not(HasSubstr("ODbL"))));
}

TEST_F(MapCommands, IngestTellsOfASourceFarFromAllThatTheMapHolds) {
  const auto told_of_roads_at = [&](double degrees_east) {
    const std::vector<double> box = nlohmann::json::parse(roadfix("info --json " + path.string()).out)["bbox"];
    const double lon = box[0] + degrees_east;
    const nlohmann::json road{
        {"type", "Feature"},
        {"properties", {{"highway", "primary"}}},
        {"geometry", {{"type", "LineString"}, {"coordinates", {{lon, box[1]}, {lon + 0.002, box[1] + 0.002}}}}}};
    std::ofstream(folder / "roads.geojson") << road;
    const ProgramResult result =
        roadfix("ingest " + (folder / "roads.geojson").string() + " --dry-run --map " + path.string());
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_THAT(told_of_roads_at(0.05), Not(HasSubstr("latitude and longitude may be swapped")));
  EXPECT_THAT(told_of_roads_at(0.7),
              ::testing::AllOf(HasSubstr("note: it lies 61 km"), HasSubstr("latitude and longitude may be swapped")));
}

TEST_F(MapCommands, IngestRefusesOptionsThatDoNothingWithItsSources) {
  const std::string pixels = folder / "m.tif";
  ASSERT_EQ(roadfix("export " + path.string() + " " + pixels).code, 0);
  const std::string ingest = "ingest " + pixels + " --as roads --map " + (folder / "n.gpkg").string();
  for (const char* option : {"--extent 38.2,37.7,38.3,37.8", "--layer roads", "--classes primary", "--width 6",
                             "--class-attribute kind", "--width-attribute breite"}) {
    const ProgramResult result = roadfix(ingest + " " + option);
    EXPECT_EQ(result.code, 1) << option;
    EXPECT_THAT(result.err, HasSubstr("[option-without-effect]")) << option;
  }
  const std::string lines = folder / "roads.geojson";
  std::ofstream(lines) << R"({"type": "LineString", "coordinates": [[38.2, 37.7], [38.21, 37.71]]})";
  EXPECT_THAT(roadfix("ingest " + lines + " --nodata-color white --map " + (folder / "n.gpkg").string()).err,
              HasSubstr("[option-without-effect]"));
  for (const char* option : {"--detector tree", "--orientations 8", "--model net.onnx", "--tree-alpha 0.3"}) {
    EXPECT_THAT(roadfix(ingest + " " + lines + " " + option).err, HasSubstr("[option-without-effect]")) << option;
  }
  EXPECT_EQ(roadfix(ingest + " " + lines + " --width 6 --nodata-color white").code, 0) << "one for each";
}

TEST_F(MapCommands, IngestKnowsWhatSourcesAndCellsOfAMapMayBe) {
  const std::string ingest = "ingest " + path.string() + " --map " + (folder / "n.gpkg").string();
  const ProgramResult meaning = roadfix(ingest + " --as road");
  EXPECT_EQ(meaning.code, 2);
  EXPECT_THAT(meaning.err, HasSubstr("{auto,imagery,roads}"));
  const ProgramResult cells = roadfix(ingest + " --cell 3");
  EXPECT_EQ(cells.code, 2);
  EXPECT_THAT(cells.err, HasSubstr("{0.25,0.5,1,2,4,8,16}"));
}

TEST_F(MapCommands, ADryRunRefusesWhatTheIngestWouldRefuse) {
  const std::string map = folder / "n.gpkg";
  const std::string lines = folder / "roads.geojson";
  std::ofstream(lines) << R"({"type": "LineString", "coordinates": [[38.2, 37.7], [38.21, 37.71]]})";
  const std::string ingest = "ingest " + lines + " --map " + map;
  ASSERT_EQ(roadfix(ingest).code, 0);
  EXPECT_EQ(roadfix(ingest + " --dry-run").code, 0);
  const ProgramResult other = roadfix(ingest + " --width 9 --dry-run");
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.err, HasSubstr("[source-exists]"));
  EXPECT_EQ(roadfix(ingest + " --width 9 --dry-run --replace").code, 0);
  EXPECT_THAT(roadfix(ingest + " --cell 4 --dry-run").err, HasSubstr("[map-settings-differ]"));
}

TEST_F(MapCommands, ADryRunSaysWhatRoomTheMapWillTakeAndHas) {
  const std::string lines = folder / "roads.geojson";
  std::ofstream(lines) << R"({"type": "LineString", "coordinates": [[38.2, 37.7], [38.201, 37.701]]})";
  const std::string plan = "ingest " + lines + " --dry-run --map ";
  const auto json = nlohmann::json::parse(roadfix(plan + (folder / "n.gpkg").string() + " --json").out);
  EXPECT_EQ(json["expected_bytes"], 150'000 + 50'000 * json["blocks"].get<int>());
  EXPECT_GT(json["free_bytes"], json["expected_bytes"]);
  EXPECT_THAT(roadfix(plan + (folder / "n.gpkg").string()).out, ::testing::ContainsRegex("expected_bytes 0[.]. MB"));
  EXPECT_THAT(roadfix(plan + "/proc/n.gpkg").err, HasSubstr("its disk has 0 MB free"));
}

TEST_F(MapCommands, ADryRunAsksForNoRoomForWhatTheMapHolds) {
  const std::string lines = folder / "roads.geojson";
  std::ofstream(lines) << R"({"type": "LineString", "coordinates": [[38.2, 37.7], [38.201, 37.701]]})";
  const std::string ingest = "ingest " + lines + " --json --map " + (folder / "n.gpkg").string();
  ASSERT_EQ(roadfix(ingest).code, 0);
  EXPECT_EQ(nlohmann::json::parse(roadfix(ingest + " --dry-run").out)["expected_bytes"], 0);
  const auto other = nlohmann::json::parse(roadfix(ingest + " --dry-run --replace --width 9").out);
  EXPECT_EQ(other["expected_bytes"], 50'000 * other["blocks"].get<int>()) << "the old one is there until it is done";
}

TEST_F(MapCommands, IngestSaysThatNothingIsReplacedWhereTheNewerVersionHasAnotherName) {
  const std::string lines = folder / "roads.geojson";
  std::ofstream(lines) << R"({"type": "LineString", "coordinates": [[38.2, 37.7], [38.21, 37.71]]})";
  const std::string newer = folder / "roads_2024.geojson";
  std::filesystem::copy_file(lines, newer);
  const std::string into = " --replace --dry-run --map " + (folder / "n.gpkg").string();
  EXPECT_THAT(roadfix("ingest " + lines + into).err, Not(HasSubstr("replaces nothing"))) << "of a new map";
  ASSERT_EQ(roadfix("ingest " + lines + " --map " + (folder / "n.gpkg").string()).code, 0);
  const ProgramResult result = roadfix("ingest " + newer + into);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the map has no source 'roads_2024', it has 'roads'. If"));
  EXPECT_THAT(roadfix("ingest " + newer + " --name roads" + into).err, Not(HasSubstr("replaces nothing")));
}

TEST_F(MapCommands, IngestSaysHowMuchGroundAReplacementTakesOutOfTheMap) {
  const auto tif = [&](const std::string& name, const std::string& region) {
    EXPECT_EQ(roadfix("export " + path.string() + " " + (folder / name).string() + region).code, 0);
    return (folder / name).string();
  };
  const std::string town = tif("town.tif", "");
  const GridBox block = tile_geometry(some_blocks(2).front(), 2.0).box();
  const LatLon sw = settings_37n().zone.unproject({block.min.east_m + 100.0, block.min.north_m + 100.0});
  const LatLon ne = settings_37n().zone.unproject({block.max.east_m - 100.0, block.max.north_m - 100.0});
  std::string bbox = " --bbox";
  for (const double degrees : {sw.lon_deg, sw.lat_deg, ne.lon_deg, ne.lat_deg}) bbox += " " + std::to_string(degrees);
  const std::string part = tif("part.tif", bbox);
  const std::string into = " --name town --as roads --map " + (folder / "n.gpkg").string();
  ASSERT_EQ(roadfix("ingest " + town + into).code, 0);
  for (const char* run : {" --dry-run", ""}) {
    EXPECT_THAT(roadfix("ingest " + part + into + " --replace" + run).err,
                HasSubstr("--replace takes 0.8 of 1.0 km2 of the old 'town' out of the map"));
  }
  EXPECT_THAT(roadfix("ingest " + town + into + " --replace").err, Not(HasSubstr("out of the map")));
}

TEST_F(MapCommands, IngestOfAFolderOfDistantPlacesProposesASourceForEach) {
  const auto write_roads = [&](const std::string& name, double lat) {
    std::ofstream(folder / name) << nlohmann::json{{"type", "LineString"},
                                                   {"coordinates", {{38.0, lat}, {39.0, lat}, {39.0, lat + 0.1}}}};
  };
  std::filesystem::create_directory(folder / "cities");
  write_roads("cities/a.geojson", 1.0);
  write_roads("cities/b.geojson", 70.0);
  const ProgramResult result =
      roadfix("ingest " + (folder / "cities").string() + " --map " + (folder / "n.gpkg").string());
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, ::testing::AllOf(HasSubstr("ingest those of each place as a source of its own"),
                                           HasSubstr("[source-too-large]")));
}

TEST_F(MapCommands, AMistypedSubcommandIsNamed) {
  const ProgramResult mistyped = roadfix("ingset a.tif --map " + path.string());
  EXPECT_EQ(mistyped.code, 2);
  EXPECT_THAT(mistyped.err, HasSubstr("no subcommand 'ingset'"));
  EXPECT_THAT(roadfix("").err, HasSubstr("A subcommand is required"));
  EXPECT_THAT(roadfix("info").err, HasSubstr("map is required"));
  EXPECT_THAT(roadfix("info " + path.string() + " --jsn").err, HasSubstr("--jsn"));
}

TEST_F(MapCommands, APathThatTheSystemRefusesIsNamedWithItsReasonAndACode) {
  std::filesystem::create_symlink("round.tif", folder / "round.tif");
  const ProgramResult result = roadfix("ingest " + (folder / "round.tif").string() + " --map " + path.string());
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.err,
            "roadfix: " + (folder / "round.tif").string() + ": Too many levels of symbolic links [path-refused]\n");
}

}  // namespace
}  // namespace roadfix
