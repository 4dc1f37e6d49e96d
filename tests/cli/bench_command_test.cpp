// roadfix bench as a script meets it, over an invented town.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using testing::ProgramResult;
using testing::run_program;
using testing::text_of;

TEST(BenchCommand, KeepsItsFiguresWhereTheyAreTooFewToLearnFrom) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "town.json")
      << R"({"maps": [{"name": "town", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "image": null, "count": 2, "footprint_m": [300, 300], "prior": {"radius_m": 200}}]})";
  const std::string manifest = (folder / "town.json").string();
  EXPECT_THAT(run_program(folder.path(), "bench " + manifest + " --json " + manifest).err,
              HasSubstr("target-is-source"));
  EXPECT_THAT(run_program(folder.path(), "bench " + manifest + " --calibrate-headings nowhere.json").err,
              HasSubstr("file-not-found"));
  for (const char* option : {" --curves ", " --pictures "}) {
    EXPECT_THAT(run_program(folder.path(), "bench " + manifest + option + manifest).err,
                HasSubstr("[result-unwritable]"));
  }
  const std::string file = (folder / "out.json").string();
  const ProgramResult bench =
      run_program(folder.path(), "bench " + (folder / "town.json").string() + " --detector tree --map-cache " +
                                     (folder / "cache").string() + " --json " + file + " --calibrate " +
                                     (folder / "calibration.json").string());
  EXPECT_EQ(bench.code, 1);
  EXPECT_THAT(bench.err, HasSubstr("calibration-too-few-examples"));
  EXPECT_EQ(nlohmann::json::parse(text_of(file), nullptr, false).value("results", nlohmann::json::array()).size(), 1U);
}

TEST(BenchCommand, WritesNothingButItsFiguresToStandardOutput) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "town.json")
      << R"({"maps": [{"name": "town", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "image": null, "count": 1, "footprint_m": [300, 300], "prior": {"radius_m": 200}}]})";
  const ProgramResult bench =
      run_program(folder.path(), "bench " + (folder / "town.json").string() + " --detector tree --map-cache " +
                                     (folder / "cache").string() + " --json /dev/stdout");
  ASSERT_EQ(bench.code, 0) << bench.err;
  const auto document = nlohmann::json::parse(bench.out);
  EXPECT_EQ(document["options"]["--detector"], std::vector<std::string>{"tree"}) << "to repeat it by";
  EXPECT_FALSE(document["options"].contains("--cell")) << "was not given";
}

TEST(BenchCommand, KeepsMapsInTheFolderForTemporaryFilesWhereNoHomeIsNamed) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "town.json")
      << R"({"maps": [{"name": "town", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "image": null, "count": 1, "footprint_m": [300, 300], "prior": {"radius_m": 200}}]})";
  const auto start = folder / "start";
  const auto temporary = folder / "temporary";
  std::filesystem::create_directory(start);
  std::filesystem::create_directory(temporary);
  const std::string command =
      fmt::format("cd {} && HOME= XDG_CACHE_HOME=cache TMPDIR={} {} bench {} --detector tree >{} 2>&1", start.string(),
                  temporary.string(), ROADFIX_PROGRAM, (folder / "town.json").string(), (folder / "said").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << text_of(folder / "said");
  EXPECT_TRUE(std::filesystem::is_empty(start));
  EXPECT_FALSE(std::filesystem::is_empty(temporary / "roadfix"));
}

TEST(BenchCommand, ReadsMapsInMoreOrientationsThanFramesWhereItIsTold) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "town.json")
      << R"({"maps": [{"name": "town", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "image": null, "count": 1, "footprint_m": [300, 300], "prior": {"radius_m": 200}}]})";
  const std::string command = "bench " + (folder / "town.json").string() + " --detector neural --map-cache " +
                              (folder / "cache").string() + " --json /dev/stdout";
  const auto readers = [&](const std::string& options) {
    const auto document = nlohmann::json::parse(run_program(folder.path(), command + options).out, nullptr, false);
    return document.value("map_detector", "") + " and " + document.value("detector", "");
  };
  EXPECT_THAT(readers(" --map-orientations 4"), MatchesRegex("neural .*=4 and neural .*=1"));
  EXPECT_THAT(readers(" --orientations 4"), MatchesRegex("neural .*=4 and neural .*=4"));
}

TEST(BenchCommand, AsksNothingWhereNoAnswerWouldTeachTheCalibrationAnything) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "town.json")
      << R"({"maps": [{"name": "town", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "image": null, "count": 1, "footprint_m": [300, 300]}], "methods": ["sift"]})";
  for (const char* option : {" --calibrate ", " --calibrate-headings "}) {
    const ProgramResult bench = run_program(folder.path(), "bench " + (folder / "town.json").string() + option +
                                                               "mine.json --map-cache " + (folder / "cache").string());
    EXPECT_EQ(bench.code, 1);
    EXPECT_THAT(bench.err, HasSubstr("[calibration-too-few-examples]"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "cache"));
}

TEST(BenchCommand, RunsNoMethodWhereAnEmptyTextNamesThem) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "town.json")
      << R"({"maps": [{"name": "town", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "image": null, "count": 1, "footprint_m": [300, 300]}]})";
  const ProgramResult bench = run_program(folder.path(), "bench " + (folder / "town.json").string() + " --methods ''");
  EXPECT_EQ(bench.code, 1);
  EXPECT_THAT(bench.err, HasSubstr("[method-unknown]"));
}

}  // namespace
}  // namespace roadfix
