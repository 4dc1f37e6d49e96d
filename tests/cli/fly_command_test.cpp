// roadfix fly as a script meets it: a rendered town is mapped, and flown over after its earthquake. Each test makes it
// anew, in a process of its own: it is coarse.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;
using testing::text_of;

constexpr int kFrames = 3;

/// Of a table of steps, whose last column is time.
std::string without_times(const std::string& text) {
  std::string kept;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    kept += text.substr(at, text.rfind(',', end) - at) + '\n';
    at = end + 1;
  }
  return kept;
}

/// The frames of a table as of a camera that leans, with a column of this name for its height.
void write_as_of_a_camera(const std::string& from, const std::string& to, const std::string& height, double height_m) {
  std::istringstream lines(text_of(from));
  std::ofstream camera(to);
  for (std::string line; std::getline(lines, line);) {
    camera << line.substr(0, line.rfind(','));
    if (line.starts_with("file,")) {
      camera << ',' << height << ",focal_px,roll_deg,pitch_deg\n";
    } else {
      camera << ',' << height_m << ",250,2,-5\n";
    }
  }
}

/// Around the town.
void write_level_elevation_model(const std::string& name, double height_m) {
  std::ofstream(name + ".prj")
      << R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],)"
      << R"(UNIT["degree",0.0174532925199433]])";
  std::ofstream model(name + ".asc");
  model << "ncols 100\nnrows 100\nxllcorner 38.22\nyllcorner 37.71\ncellsize 0.001\n";
  for (int cell = 0; cell < 100 * 100; ++cell) model << height_m << ' ';
}

class FlyCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_folder = new testing::TemporaryFolder;
    const std::string town = (*shared_folder / "town").string();
    const std::string rendering = " --size-km 0.7x0.7 --gsd 1 --footprint-m 300 --frames " + std::to_string(kFrames);
    ASSERT_EQ(roadfix("world " + town + rendering).code, 0);
    ASSERT_EQ(roadfix("ingest " + town + "/roads.geojson --map " + map()).code, 0);
  }
  static void TearDownTestSuite() {
    delete shared_folder;
    shared_folder = nullptr;
  }

  static std::string map() { return (*shared_folder / "town.gpkg").string(); }
  static std::string after() { return (*shared_folder / "town").string() + "/post.tif"; }
  static std::string file(const std::string& name) { return (*shared_folder / name).string(); }
  static ProgramResult roadfix(const std::string& arguments) { return run_program(shared_folder->path(), arguments); }

 private:
  static testing::TemporaryFolder* shared_folder;
};

testing::TemporaryFolder* FlyCommand::shared_folder = nullptr;

TEST_F(FlyCommand, FollowsAVehicleOverImageryAndWritesWhatHappened) {
  const ProgramResult flown = roadfix(
      "fly " + map() + " --over " + after() +
      " --detector tree --tree-roots 500 --footprint-m 300 --steps 6 --particles 500 --filter paper,default --json " +
      file("out.json") + " --csv " + file("out.csv") + " --geojson " + file("out.geojson") + " --film " +
      file("film.gif") + " --pictures " + file("pictures") + " --picture-steps 2 --picture-px 200");
  ASSERT_EQ(flown.code, 0) << flown.err;
  EXPECT_THAT(flown.out, HasSubstr("default"));
  const auto document = nlohmann::json::parse(text_of(file("out.json")));
  EXPECT_EQ(document["filters"]["paper"]["runs"], 1);
  EXPECT_EQ(document["options"]["--filter"], (std::vector<std::string>{"paper", "default"})) << "to repeat it by";
  EXPECT_EQ(document["options"]["--steps"], std::vector<std::string>{"6"});
  EXPECT_FALSE(document["options"].contains("--seed")) << "was not given";
  EXPECT_EQ(document["filters"]["default"]["flights"][0]["steps"], 6);
  const std::string table = text_of(file("out.csv"));
  EXPECT_EQ(std::ranges::count(table, '\n'), 13);
  EXPECT_EQ(nlohmann::json::parse(text_of(file("out.geojson")))["type"], "FeatureCollection");
  EXPECT_TRUE(std::filesystem::exists(file("pictures/paper-0002.png")));
  EXPECT_GT(std::filesystem::file_size(file("film.gif")), 1000u);
}

TEST_F(FlyCommand, TakesNoWideCircleForAKnownStart) {
  const std::string fly = "fly " + map() + " --footprint-m 200 --steps 2 --particles 300 --known-start";
  EXPECT_EQ(roadfix(fly + " --start-radius 150 --start-heading-range 15").code, 0);
  const ProgramResult wide = roadfix(fly + " --start-radius 151");
  EXPECT_NE(wide.code, 0);
  EXPECT_THAT(wide.err, HasSubstr("a --start-radius of 151 m is too wide"));
  const ProgramResult nowhere = roadfix(fly);
  EXPECT_NE(nowhere.code, 0);
  EXPECT_THAT(nowhere.err, HasSubstr("--start-radius"));
}

TEST_F(FlyCommand, WritesNothingButItsFiguresToStandardOutput) {
  const ProgramResult flown =
      roadfix("fly " + map() + " --footprint-m 200 --steps 2 --particles 300 --json /dev/stdout");
  ASSERT_EQ(flown.code, 0) << flown.err;
  EXPECT_TRUE(nlohmann::json::accept(flown.out)) << flown.out;
  EXPECT_THAT(flown.err, HasSubstr("default"));
}

TEST_F(FlyCommand, ReplaysARecordedFlight) {
  const std::string replay = "fly " + map() + " --over " + file("town/frames/frames.csv") +
                             " --detector tree --tree-roots 500 --particles 500";
  const ProgramResult flown = roadfix(replay + " --csv " + file("replay.csv"));
  ASSERT_EQ(flown.code, 0) << flown.err;
  EXPECT_THAT(flown.out, HasSubstr("frames.csv"));
  const std::string table = text_of(file("replay.csv"));
  EXPECT_EQ(std::ranges::count(table, '\n'), 1 + kFrames);
  EXPECT_THAT(roadfix(replay + " --course survey").err, HasSubstr("option-without-effect"));
}

TEST_F(FlyCommand, ReplaysAFlightByItsHeightsAboveTheSeaOverAMapThatKnowsThatOfItsGround) {
  write_as_of_a_camera(file("town/frames/frames.csv"), file("town/frames/agl.csv"), "agl_m", 150.0);
  write_as_of_a_camera(file("town/frames/frames.csv"), file("town/frames/alt.csv"), "alt_m", 850.0);
  const auto flown = [](const std::string& name, const std::string& more = "") {
    return roadfix("fly " + map() + " --over " + file("town/frames/" + name) +
                   " --detector tree --tree-roots 500 --particles 500 --csv " + file(name + "-flown.csv") + more);
  };
  EXPECT_THAT(flown("alt.csv").err,
              AllOf(HasSubstr("frame_01.png: the map town does not know how high"), HasSubstr("[terrain-missing]")));
  write_level_elevation_model(file("dem"), 700.0);
  ASSERT_EQ(roadfix("terrain " + map() + " " + file("dem.asc")).code, 0);
  ASSERT_EQ(flown("agl.csv").code, 0);
  const ProgramResult by_altitude = flown("alt.csv");
  ASSERT_EQ(by_altitude.code, 0) << by_altitude.err;
  EXPECT_EQ(without_times(text_of(file("alt.csv-flown.csv"))), without_times(text_of(file("agl.csv-flown.csv"))));
  EXPECT_THAT(flown("alt.csv", " --server http://127.0.0.1:9").err, HasSubstr("add --send frames"));
}

/// Its detector has started threads by the time that it is ready to stop, and a signal goes to any that takes it.
TEST_F(FlyCommand, FliesACourseOfAFileToItsEnd) {
  std::ofstream(file("course.geojson"))
      << R"({"type":"LineString","coordinates":[[38.2730,37.7625],[38.2730,37.7655],[38.2765,37.7655],[38.2765,37.7625]]})";
  const std::string flight = "fly " + map() + " --footprint-m 200 --particles 300 --frame-every 50 --course " +
                             file("course.geojson") + " --speed 5 --turn-rate ";
  const auto steps_of = [&](const std::string& more) {
    const ProgramResult flown = roadfix(flight + "30" + more + " --json " + file("course.json"));
    EXPECT_EQ(flown.code, 0) << flown.err;
    return nlohmann::json::parse(text_of(file("course.json")))["filters"]["default"]["flights"][0]["steps"].get<int>();
  };
  // 333 m north, 308 m east and 333 m back south; the last steps and the corners are cut by the turning circle.
  EXPECT_NEAR(steps_of(""), (333.0 + 308.0 + 333.0) / 5.0, 15.0);
  EXPECT_EQ(steps_of(" --steps 20"), 20);
  EXPECT_THAT(roadfix(flight + "0").err, HasSubstr("is not flown to its end in 100000 steps"));
}

TEST_F(FlyCommand, SaysWhichFramesOfARecordedFlightWereTakenBeyondTheMap) {
  std::ofstream(file("town/frames/BEYOND.CSV"))
      << "file,time_s,lat,lon,heading_deg,gsd_m\nframe_01.png,1,37.764,38.275,0,1\nframe_02.png,999,37.8,38.275,0,1\n";
  const ProgramResult flown = roadfix("fly " + map() + " --over " + file("town/frames/BEYOND.CSV") +
                                      " --detector tree --tree-roots 500 --particles 300");
  EXPECT_EQ(flown.code, 0) << flown.err;
  EXPECT_THAT(flown.err, HasSubstr("note: 1 of the 2 frames"));
}

TEST_F(FlyCommand, StopsInGoodOrderAtASignal) {
  const std::string flight = ROADFIX_PROGRAM " fly " + map() + " --over " + after() +
                             " --detector tree --tree-roots 500 --footprint-m 300 --runs 1000 --particles 500";
  const std::string err = file("signal-err");  // of no program before, whose progress would be taken for its own
  const std::string script = flight + " >" + file("out") + " 2>" + err + " & flight=$!; while kill -0 $flight && " +
                             "! grep -q flying " + err + "; do sleep 0.05; done; kill -TERM $flight; wait $flight";
  const int status = std::system(script.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1) << text_of(err);
}

TEST_F(FlyCommand, RepeatsAFlightOverTheMapItselfFromItsSeed) {
  const std::string flight =
      "fly " + map() + " --footprint-m 200 --steps 5 --particles 300 --seed 9 --runs 2 --registration 3 --csv ";
  ASSERT_EQ(roadfix(flight + file("a.csv")).code, 0);
  ASSERT_EQ(roadfix(flight + file("b.csv")).code, 0);
  EXPECT_EQ(without_times(text_of(file("a.csv"))), without_times(text_of(file("b.csv"))));
}

TEST_F(FlyCommand, SaysWhatIsWrongWithItsArguments) {
  const ProgramResult large = roadfix("fly " + map() + " --footprint-m 3000");
  EXPECT_EQ(large.code, 1);
  EXPECT_THAT(large.err, HasSubstr("no-place-to-fly"));
  EXPECT_THAT(roadfix("fly " + map() + " --footprint-m 200 --filter best").err, HasSubstr("filter-unknown"));
  EXPECT_THAT(roadfix("fly " + map() + " --footprint-m 200 --filter paper,default,paper").err,
              HasSubstr("names paper twice"));
  EXPECT_EQ(roadfix("fly " + map() + " --steps none").code, 2);
  EXPECT_EQ(roadfix("fly " + map() + " --erase 20").code, 2);
  EXPECT_EQ(roadfix("fly " + map() + " --course survey --lane-m 0.001").code, 2);
  EXPECT_EQ(roadfix("fly " + map() + " --step-s 1e-9").code, 2);
  EXPECT_EQ(roadfix("fly " + map() + " --footprint-m 0.1 --steps 2 --particles 300").code, 0) << "it shows a cell";
  EXPECT_THAT(roadfix("fly " + map() + " --footprint-m 200 --alt 900 --agl 0").err, HasSubstr("--agl 0 with --alt"));
  const std::string eight_steps = "fly " + map() + " --footprint-m 200 --steps 8";
  EXPECT_THAT(roadfix(eight_steps + " --kidnap 8,200").err, HasSubstr("comes after the flight"));
  EXPECT_THAT(roadfix(eight_steps + " --kidnap 2.5,200").err, HasSubstr("lies between two steps"));
  EXPECT_THAT(roadfix(eight_steps + " --outage 5,3").err, HasSubstr("leaves out no frame"));
  EXPECT_THAT(roadfix(eight_steps + " --outage 8,10").err, HasSubstr("[bad-parameter]"));
  const std::string elsewhere = file("elsewhere");
  ASSERT_EQ(roadfix("world " + elsewhere + " --centre 37.9,38.3 --size-km 0.3x0.3 --gsd 1 --frames 0").code, 0);
  const ProgramResult apart = roadfix("fly " + map() + " --detector tree --over " + elsewhere + "/post.tif");
  EXPECT_THAT(apart.err, HasSubstr("is no part of the map"));
  EXPECT_THAT(roadfix(eight_steps + " --black-unseen").err, HasSubstr("about recorded flights"));
  EXPECT_THAT(roadfix(eight_steps + " --csv " + map()).err, HasSubstr("target-is-source"));
  for (const char* output : {" --json", " --film"}) {
    const ProgramResult lost = roadfix("fly " + map() + " --footprint-m 200" + output + " /no/such/folder/out");
    EXPECT_THAT(lost.err, HasSubstr("[result-unwritable]"));
    EXPECT_THAT(lost.err, Not(HasSubstr("flying"))) << "said before the flights, not after them";
  }
  EXPECT_THAT(roadfix("fly " + map() + " --footprint-m 200 --pictures " + map() + "/beside").err,
              HasSubstr("[result-unwritable]"));
  EXPECT_THAT(roadfix("fly " + map() + " --footprint-m 200 --pictures -").err, HasSubstr("[target-is-dash]"));
  const std::string over_service = "fly " + map() + " --footprint-m 200 --steps 1 --vehicles 2 --map town --server ";
  EXPECT_THAT(roadfix(over_service + "127.0.0.1").err, HasSubstr("bad-url"));
  EXPECT_THAT(roadfix(over_service + "http://127.0.0.1:1 --patience 0").err, HasSubstr("service-silent"));
}

TEST_F(FlyCommand, RefusesOptionsThatWouldDoNothing) {
  const std::string flight = "fly " + map() + " --footprint-m 200 --steps 1 ";
  for (const char* of_a_service : {"--map town", "--patience 5", "--keep-tracks"}) {
    const ProgramResult flown = roadfix(flight + of_a_service);
    EXPECT_EQ(flown.code, 2) << of_a_service;
    EXPECT_THAT(flown.err, HasSubstr("requires --server"));
  }
  EXPECT_THAT(roadfix(flight + "--picture-steps 1").err, HasSubstr("requires --pictures"));
  EXPECT_THAT(roadfix(flight + "--film-rate 5").err, HasSubstr("requires --film"));
  EXPECT_THAT(roadfix(flight + "--server http://127.0.0.1:1 --filter default,paper").err,
              HasSubstr("option-without-effect"));
}

TEST_F(FlyCommand, SendsFramesOnlyWhereItHasSomeAndAServiceDetectsTheirRoads) {
  const std::string frames = "fly " + map() + " --footprint-m 200 --steps 1 --send frames";
  const std::string service = " --server http://127.0.0.1:1 --patience 0";
  EXPECT_THAT(roadfix(frames + " --over " + after()).err, HasSubstr("name it with --server"));
  EXPECT_THAT(roadfix(frames + service).err, HasSubstr("shows roads and no pictures"));
  for (const char* of_a_detector : {"--detector tree", "--orientations 4", "--tree-roots 500", "--tree-fan-width 30"}) {
    EXPECT_THAT(roadfix(frames + service + " --over " + after() + " " + of_a_detector).err,
                HasSubstr("[option-without-effect]"))
        << of_a_detector;
  }
  EXPECT_THAT(roadfix(frames + service + " --over " + after()).err, HasSubstr("service-silent"));
  EXPECT_EQ(roadfix("fly " + map() + " --send pictures").code, 2);
}

}  // namespace
}  // namespace roadfix
