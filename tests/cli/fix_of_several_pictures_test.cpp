// roadfix fix of several pictures in one start: a line of JSON or a row of a table for each.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "core/detect/feature_map_codec.hpp"
#include "tests/cli/localize_commands_fixture.hpp"
#include "tests/support/put_block.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using testing::LocalizeCommands;
using testing::ProgramResult;

class FixOfSeveralPictures : public LocalizeCommands {
 protected:
  FixOfSeveralPictures() {
    std::filesystem::create_directory(flight);
    std::filesystem::rename(window, flight / "a, 1.png");
    save(encode_feature_map(CellArray(160, 160, kNoRoad)), flight / "b.PNG");
    std::ofstream(flight / "c.png").flush();
    std::ofstream(flight / ".d.png") << "hidden";
    std::ofstream(flight / "e.txt") << "no picture";
  }

  std::filesystem::path flight = folder / "flight";
  std::string of_flight = "fix " + map.string() + " " + flight.string() + " --cell 2 ";
};

TEST_F(FixOfSeveralPictures, IsALineOfJsonForEachThatCanBeRead) {
  const ProgramResult result = roadfix(of_flight + "--json");
  EXPECT_EQ(result.code, 1) << "one is left out";
  std::istringstream lines(result.out);
  std::vector<nlohmann::json> answers;
  for (std::string line; std::getline(lines, line);) answers.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(answers.size(), 2U) << result.out;
  EXPECT_EQ(answers[0]["file"], (flight / "a, 1.png").string());
  EXPECT_EQ(answers[0]["status"], "fix");
  EXPECT_NEAR(answers[0]["pose"]["lat"].get<double>(), place.lat_deg, 2e-5);
  EXPECT_EQ(answers[1]["file"], (flight / "b.PNG").string());
  EXPECT_EQ(answers[1]["status"], "no_fix");
  EXPECT_THAT(result.err, HasSubstr("c.png is left out: the file is empty: copy it again [image-damaged]\n"));
  EXPECT_THAT(result.err, HasSubstr("1 of 3 pictures were left out"));
  EXPECT_THAT(result.err, HasSubstr("[pictures-left-out]\n"));
  EXPECT_THAT(result.err, HasSubstr("locating 100.0 %  3/3"));
}

TEST_F(FixOfSeveralPictures, IsARowOfATableForEachWithAPlaceOnlyWhereThereIsAFix) {
  std::filesystem::remove(flight / "c.png");
  const std::filesystem::path table = folder / "fixes.csv";
  const ProgramResult result = roadfix(of_flight + "--csv " + table.string());
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  std::istringstream rows(testing::text_of(table));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row,
            "file,status,lat,lon,heading_deg,sigma_major_m,sigma_minor_m,ellipse_heading_deg,heading_sigma_deg,"
            "probability,reason,map,map_version");
  std::getline(rows, row);
  EXPECT_EQ(row.find('"' + (flight / "a, 1.png").string() + "\",fix,57."), 0U) << row;
  std::getline(rows, row);
  EXPECT_EQ(row.find((flight / "b.PNG").string() + ",no_fix,,,,,,,,0.0000,"), 0U) << row;
  EXPECT_THAT(row, HasSubstr(",town,"));
  EXPECT_FALSE(std::getline(rows, row));
}

TEST_F(FixOfSeveralPictures, IsInTheTableUpToWhateverEndsTheCommand) {
  const std::filesystem::path pipe = folder / "pipe.png";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  {
    // Of less certain ground there is more to be asked of the map for every picture.
    MapWriter writer = MapWriter::existing(map);
    const SourceRecord less_certain{
        .name = "b", .content = SourceContent::kRoads, .fingerprint = "b", .provenance = {.registration_sigma_m = 9.0}};
    const TileIndex block = tiles_covering(town.geometry).front();
    writer.begin_source(less_certain, std::vector{block}, false);
    testing::put_block(writer, "b", block, CellArray(kTileCells, kTileCells));
    writer.finish_source("b");
  }
  const std::vector<std::uint8_t> picture = encode_feature_map(what_is_seen(truth, 160).cells);
  std::thread second([&] {
    std::ofstream into(pipe, std::ios::binary);  // opens once the command reads it, with the first one answered
    MapWriter::existing(map).remove_source("town");
    into.write(reinterpret_cast<const char*>(picture.data()), static_cast<std::streamsize>(picture.size()));
  });
  const std::filesystem::path table = folder / "fixes.csv";
  const std::string first = (flight / "a, 1.png").string();
  const ProgramResult result =
      roadfix("fix " + map.string() + " '" + first + "' " + pipe.string() + " --cell 2 --csv " + table.string());
  close(open(pipe.c_str(), O_RDONLY | O_NONBLOCK));  // lets the second one end in any case
  second.join();
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("[map-renewed]"));
  EXPECT_THAT(testing::text_of(table), HasSubstr('"' + first + "\",fix,57."));
}

TEST_F(FixOfSeveralPictures, IsAskedWithoutWhatHoldsForOneAlone) {
  EXPECT_EQ(roadfix(of_flight + "--also x.png,1,2,3").code, 2);
  EXPECT_EQ(roadfix(of_flight + "--json --csv fixes.csv").code, 2);
  const std::string picture = (flight / "a, 1.png").string();
  EXPECT_THAT(roadfix(of_flight + "--csv '" + picture + "'").err, HasSubstr("[target-is-source]"));
  std::filesystem::create_directory(folder / "empty");
  EXPECT_THAT(roadfix("fix " + map.string() + " " + (folder / "empty").string()).err, HasSubstr("[no-pictures]"));
}

TEST_F(LocalizeCommands, FixOfASinglePictureTellsWhyItCannotBeUsedForATableToo) {
  std::ofstream(folder / "empty.png").flush();
  const ProgramResult result = roadfix("fix " + map.string() + " " + (folder / "empty.png").string() +
                                       " --cell 2 --csv " + (folder / "fixes.csv").string());
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("[image-damaged]"));
  EXPECT_THAT(result.err, Not(HasSubstr("left out")));
}

}  // namespace
}  // namespace roadfix
