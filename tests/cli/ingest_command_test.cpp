// roadfix ingest as a script meets it: exit codes, JSON on stdout, notes and errors on stderr.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/map_commands_fixture.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::settings_37n;
using testing::some_blocks;

class IngestCommand : public testing::MapCommands {
 protected:
  /// A file with one road that goes so far to the north and east.
  std::string road(LatLon from = {37.7, 38.2}, double degrees = 0.01) const {
    const auto [lat, lon] = from;
    std::ofstream(folder / "roads.geojson")
        << nlohmann::json{{"type", "LineString"}, {"coordinates", {{lon, lat}, {lon + degrees, lat + degrees}}}};
    return folder / "roads.geojson";
  }

  const std::string other_map = folder / "n.gpkg";
};

TEST_F(IngestCommand, AnswersInJsonOfFilesWhoseNamesAreNoUtf8) {
  const std::string source = folder / "m\xfc.tif";
  ASSERT_EQ(roadfix("export " + map + " '" + source + "'").code, 0);
  const ProgramResult result = roadfix("ingest '" + source + "' --as roads --json --map " + other_map);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["source"], "m\xef\xbf\xbd");
}

TEST_F(IngestCommand, OfWhatIsNeitherImageryNorRoadsIsWrongUsage) {
  const std::string into = " --map " + other_map;
  EXPECT_EQ(roadfix("ingest " + map + " --as heights" + into).code, 2);
  EXPECT_EQ(roadfix("ingest " + map + " --as auto" + into).code, 0);
}

TEST_F(IngestCommand, TakesNoMapForASourceOfItself) {
  const auto before = testing::tile_bytes(map);
  const std::string as_roads = " --as roads --name again --map " + map;
  const ProgramResult result = roadfix("ingest " + map + as_roads);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("[source-is-target]"));
  EXPECT_THAT(roadfix("ingest " + folder.path().string() + as_roads).err, HasSubstr("[source-empty]"));
  road();
  const ProgramResult beside = roadfix("ingest " + folder.path().string() + as_roads + " --dry-run");
  EXPECT_EQ(beside.code, 0) << beside.err;
  EXPECT_THAT(beside.err, Not(HasSubstr("left out")));
  EXPECT_EQ(testing::tile_bytes(map), before);
}

TEST_F(IngestCommand, WantsANameForTheMap) {
  EXPECT_THAT(roadfix("ingest " + map + " --map -").err, HasSubstr("[target-is-dash]"));
}

TEST_F(IngestCommand, TakesOutWhatWasToldOfASource) {
  const std::string ingest = "ingest " + road() + " --map " + other_map;
  ASSERT_EQ(roadfix(ingest + " --licence ODbL --date 2023").code, 0);
  const ProgramResult again = roadfix(ingest + " --licence ''");
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err, HasSubstr("'roads' now has licence none instead of 'ODbL'"));
  EXPECT_THAT(roadfix("info " + other_map).out, AllOf(HasSubstr("2023"), Not(HasSubstr("ODbL"))));
}

TEST_F(IngestCommand, TellsOfASourceFarFromAllThatTheMapHolds) {
  const std::vector<double> box = nlohmann::json::parse(roadfix("info --json " + map).out)["bbox"];
  const auto told_of_roads_at = [&](double degrees_east) {
    const std::string lines = road({box[1], box[0] + degrees_east}, 0.002);
    const ProgramResult result = roadfix("ingest " + lines + " --dry-run --map " + map);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_THAT(told_of_roads_at(0.05), Not(HasSubstr("latitude and longitude may be swapped")));
  EXPECT_THAT(told_of_roads_at(0.7),
              AllOf(HasSubstr("note: it lies 61 km"), HasSubstr("latitude and longitude may be swapped")));
}

TEST_F(IngestCommand, RefusesOptionsThatDoNothingWithItsSources) {
  const std::string pixels = folder / "m.tif";
  ASSERT_EQ(roadfix("export " + map + " " + pixels).code, 0);
  const std::string ingest = "ingest " + pixels + " --as roads --map " + other_map;
  for (const char* option : {"--extent 38.2,37.7,38.3,37.8", "--layer roads", "--classes primary", "--width 6",
                             "--class-attribute kind", "--width-attribute breite"}) {
    const ProgramResult result = roadfix(ingest + " " + option);
    EXPECT_EQ(result.code, 1) << option;
    EXPECT_THAT(result.err, HasSubstr("[option-without-effect]")) << option;
  }
  const std::string lines = road();
  EXPECT_THAT(roadfix("ingest " + lines + " --nodata-color white --map " + other_map).err,
              HasSubstr("[option-without-effect]"));
  for (const char* option : {"--detector tree", "--orientations 8", "--model net.onnx", "--tree-alpha 0.3"}) {
    EXPECT_THAT(roadfix(ingest + " " + lines + " " + option).err, HasSubstr("[option-without-effect]")) << option;
  }
  EXPECT_EQ(roadfix(ingest + " " + lines + " --width 6 --nodata-color white").code, 0) << "one for each";
}

TEST_F(IngestCommand, KnowsWhatSourcesAndCellsOfAMapMayBe) {
  const std::string ingest = "ingest " + map + " --map " + other_map;
  const ProgramResult meaning = roadfix(ingest + " --as road");
  EXPECT_EQ(meaning.code, 2);
  EXPECT_THAT(meaning.err, HasSubstr("{auto,imagery,roads}"));
  const ProgramResult cells = roadfix(ingest + " --cell 3");
  EXPECT_EQ(cells.code, 2);
  EXPECT_THAT(cells.err, HasSubstr("{0.25,0.5,1,2,4,8,16}"));
}

TEST_F(IngestCommand, RefusesInADryRunWhatItWouldRefuse) {
  const std::string ingest = "ingest " + road() + " --map " + other_map;
  ASSERT_EQ(roadfix(ingest).code, 0);
  EXPECT_EQ(roadfix(ingest + " --dry-run").code, 0);
  const ProgramResult other = roadfix(ingest + " --width 9 --dry-run");
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.err, HasSubstr("[source-exists]"));
  EXPECT_EQ(roadfix(ingest + " --width 9 --dry-run --replace").code, 0);
  EXPECT_THAT(roadfix(ingest + " --cell 4 --dry-run").err, HasSubstr("[map-settings-differ]"));
}

TEST_F(IngestCommand, SaysInADryRunWhatRoomTheMapWillTakeAndHas) {
  const std::string plan = "ingest " + road({37.7, 38.2}, 0.001) + " --dry-run --map ";
  const auto json = nlohmann::json::parse(roadfix(plan + other_map + " --json").out);
  EXPECT_EQ(json["expected_bytes"], 150'000 + 50'000 * json["blocks"].get<int>());
  EXPECT_GT(json["free_bytes"], json["expected_bytes"]);
  EXPECT_THAT(roadfix(plan + other_map).out, ContainsRegex("expected_bytes 0[.]. MB"));
  EXPECT_THAT(roadfix(plan + "/proc/n.gpkg").err, HasSubstr("its disk has 0 MB free"));
}

TEST_F(IngestCommand, AsksInADryRunForNoRoomForWhatTheMapHolds) {
  const std::string ingest = "ingest " + road({37.7, 38.2}, 0.001) + " --json --map " + other_map;
  ASSERT_EQ(roadfix(ingest).code, 0);
  EXPECT_EQ(nlohmann::json::parse(roadfix(ingest + " --dry-run").out)["expected_bytes"], 0);
  const auto other = nlohmann::json::parse(roadfix(ingest + " --dry-run --replace --width 9").out);
  EXPECT_EQ(other["expected_bytes"], 50'000 * other["blocks"].get<int>()) << "the old one is there until it is done";
}

TEST_F(IngestCommand, SaysThatNothingIsReplacedWhereTheNewerVersionHasAnotherName) {
  const std::string lines = road();
  const std::string newer = folder / "roads_2024.geojson";
  std::filesystem::copy_file(lines, newer);
  const std::string into = " --replace --dry-run --map " + other_map;
  EXPECT_THAT(roadfix("ingest " + lines + into).err, Not(HasSubstr("replaces nothing"))) << "of a new map";
  ASSERT_EQ(roadfix("ingest " + lines + " --map " + other_map).code, 0);
  const ProgramResult result = roadfix("ingest " + newer + into);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the map has no source 'roads_2024', it has 'roads'. If"));
  EXPECT_THAT(roadfix("ingest " + newer + " --name roads" + into).err, Not(HasSubstr("replaces nothing")));
}

TEST_F(IngestCommand, SaysHowMuchGroundAReplacementTakesOutOfTheMap) {
  const auto tif = [&](const std::string& name, const std::string& region) {
    EXPECT_EQ(roadfix("export " + map + " " + (folder / name).string() + region).code, 0);
    return (folder / name).string();
  };
  const std::string town = tif("town.tif", "");
  const GridBox block = tile_geometry(some_blocks(2).front(), 2.0).box();
  const LatLon sw = settings_37n().zone.unproject({block.min.east_m + 100.0, block.min.north_m + 100.0});
  const LatLon ne = settings_37n().zone.unproject({block.max.east_m - 100.0, block.max.north_m - 100.0});
  std::string bbox = " --bbox";
  for (const double degrees : {sw.lon_deg, sw.lat_deg, ne.lon_deg, ne.lat_deg}) bbox += " " + std::to_string(degrees);
  const std::string part = tif("part.tif", bbox);
  const std::string into = " --name town --as roads --map " + other_map;
  ASSERT_EQ(roadfix("ingest " + town + into).code, 0);
  for (const char* run : {" --dry-run", ""}) {
    EXPECT_THAT(roadfix("ingest " + part + into + " --replace" + run).err,
                HasSubstr("--replace takes 0.8 of 1.0 km2 of the old 'town' out of the map"));
  }
  EXPECT_THAT(roadfix("ingest " + town + into + " --replace").err, Not(HasSubstr("out of the map")));
}

TEST_F(IngestCommand, OfAFolderOfDistantPlacesProposesASourceForEach) {
  const auto write_roads = [&](const std::string& name, double lat) {
    std::ofstream(folder / name) << nlohmann::json{{"type", "LineString"},
                                                   {"coordinates", {{38.0, lat}, {39.0, lat}, {39.0, lat + 0.1}}}};
  };
  std::filesystem::create_directory(folder / "cities");
  write_roads("cities/a.geojson", 1.0);
  write_roads("cities/b.geojson", 70.0);
  const ProgramResult result = roadfix("ingest " + (folder / "cities").string() + " --map " + other_map);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("ingest those of each place as a source of its own"), HasSubstr("[source-too-large]")));
}

TEST_F(IngestCommand, NamesAPathThatTheSystemRefusesWithTheReasonAndACode) {
  std::filesystem::create_symlink("round.tif", folder / "round.tif");
  const ProgramResult result = roadfix("ingest " + (folder / "round.tif").string() + " --map " + map);
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.err,
            "roadfix: " + (folder / "round.tif").string() + ": Too many levels of symbolic links [path-refused]\n");
}

}  // namespace
}  // namespace roadfix
