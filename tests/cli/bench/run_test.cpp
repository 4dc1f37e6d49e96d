// The bench as a whole over a drawn town whose detector makes no mistakes: everything must be found.
#include "cli/bench/run.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stop_token>

#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "tests/cli/bench/bench_run.hpp"

namespace roadfix::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kImageQueries = R"({"map": "town", "image": "town.png", "count": 3, "footprint_m": [300, 240]})";

TEST_F(BenchRun, PlacesFramesCutFromTheMapsOwnImageryByEveryMethod) {
  const auto results = run(kImageQueries, R"("roads", "sift", "orb")");
  ASSERT_EQ(results.size(), 3U);
  for (const SetResult& result : results) {
    const Summary s = summary_of(result.outcomes);
    EXPECT_EQ(s.n, 3) << to_string(result.method);
    EXPECT_EQ(s.recall_5, 1.0) << to_string(result.method);
    EXPECT_EQ(s.false_fixes, 0) << to_string(result.method);
    if (result.method == MethodName::kRoads) {
      EXPECT_GT(s.median_rho_at_truth.value_or(0.0), 0.8);
    } else {
      EXPECT_GT(s.mean_right_matches.value_or(0.0), 0.8 * s.mean_matches.value_or(1e9)) << to_string(result.method);
    }
    for (const Outcome& outcome : result.outcomes) {
      EXPECT_LT(outcome.heading_error_deg.value_or(360.0), 1.0) << to_string(result.method);
    }
  }
}

TEST_F(BenchRun, DrawsEveryQueryWhereAFolderIsNamed) {
  options.pictures = folder / "pictures";
  options.limit = 1;
  run(kImageQueries, R"("roads", "sift")");
  for (const char* file : {"1-roads/town/0000.jpg", "1-sift/town/0000.jpg"}) {
    const cv::Mat picture = cv::imread(options.pictures / file);
    ASSERT_FALSE(picture.empty()) << file;
    EXPECT_GT(picture.cols, picture.rows) << file;
  }
}

TEST_F(BenchRun, DrawsFramesThatLieElsewhereIntoTheFolderToo) {
  std::filesystem::create_directory(folder / "tables");
  std::string table = read_named_file(folder / "frames.csv");
  table.replace(table.find("frame.png"), 0, "../");
  std::ofstream(folder / "tables/frames.csv") << table;
  options.pictures = folder / "pictures";
  run(R"({"map": "town", "frames": "tables/frames.csv"})", R"("roads", "sift")");
  for (const char* file : {"1-roads/_/frame.png.jpg", "1-sift/_/frame.png.jpg"}) {
    EXPECT_FALSE(cv::imread(options.pictures / file).empty()) << file;
  }
}

TEST_F(BenchRun, SaysThatAPictureCannotBeWritten) {
  std::ofstream(folder / "pictures") << "a file";
  options.pictures = folder / "pictures";
  options.limit = 1;
  EXPECT_THAT([&] { run(kImageQueries, R"("roads")"); }, ThrowsMessage<IoFailure>(HasSubstr("pictures")));
}

TEST_F(BenchRun, PlacesSimulatedFeatureMapsAndRealFrames) {
  const auto results = run(R"({"map": "town", "image": null, "count": 3, "footprint_m": [300, 300],
                               "noise": {"erase": 0.1, "invent": 0.1}, "prior": {"radius_m": 300}},
                              {"map": "town", "frames": "frames.csv"})",
                           R"("roads")");
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].outcomes.size(), 3u);
  EXPECT_EQ(summary_of(results[0].outcomes).recall_5, 1.0);
  EXPECT_EQ(results[1].outcomes.at(0).id, "frame.png");
  EXPECT_LT(*results[1].outcomes.at(0).error_m, 3.0);
  EXPECT_LT(*results[1].outcomes.at(0).heading_error_deg, 1.0);
}

TEST_F(BenchRun, KnowsNoPlaceOfGroundThatIsNotOnTheMap) {
  const Manifest manifest = parse_manifest(R"({
    "maps": [{"name": "town", "sources": [{"path": "town.png", "as": "imagery"}]},
             {"name": "other", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "from": "other", "elsewhere": true, "image": null, "count": 2, "footprint_m": [200, 200]},
                {"map": "other", "image": null, "count": 2, "footprint_m": [400, 400]}],
    "methods": ["roads"]})",
                                           folder.path());
  const auto results = bench::run(manifest, options);
  ASSERT_EQ(results.size(), 2u);
  for (const Outcome& outcome : results[0].outcomes) {
    EXPECT_FALSE(outcome.truth);
    EXPECT_TRUE(!outcome.error_m || std::isinf(*outcome.error_m));
  }
  const Summary elsewhere = summary_of(results[0].outcomes);
  EXPECT_EQ(elsewhere.n, 2);
  EXPECT_EQ(elsewhere.recall_50, 0.0);
  EXPECT_EQ(summary_of(results[1].outcomes).recall_5, 1.0);
}

TEST_F(BenchRun, CountsEveryFixOfImageryAndFramesOfAnotherContinentAsFalse) {
  std::filesystem::copy_file(folder / "town.png", folder / "far.png");
  std::filesystem::copy_file(folder / "town.pgw", folder / "far.pgw");
  std::ofstream(folder / "far.png.aux.xml") << "<PAMDataset><SRS>EPSG:32721</SRS></PAMDataset>";
  std::ofstream(folder / "far.csv") << "sequence,file,lat,lon,heading_deg,gsd_m\n"
                                       "a,frame.png,-34.9,-56.2,0,1\na,frame.png,-34.9,-56.2,0,1\n";
  const auto results = run(R"({"map": "town", "image": "far.png", "count": 2, "footprint_m": [300, 300],
                               "elsewhere": true},
                              {"map": "town", "frames": "far.csv", "together": 2, "elsewhere": true})",
                           R"("roads")");
  ASSERT_EQ(results.size(), 2u);
  for (const SetResult& result : results) {
    const Summary s = summary_of(result.outcomes);
    EXPECT_EQ(s.n, 2) << result.query_set;
    EXPECT_GT(s.answered, 0) << result.query_set;  // it is the picture of the town, wherever it is said to be
    EXPECT_EQ(s.false_fixes, s.answered) << result.query_set;
  }
}

TEST_F(BenchRun, RefusesToLookForAPlaceOfAnotherZone) {
  const Manifest manifest = parse_manifest(R"({
    "maps": [{"name": "town", "sources": [{"path": "town.png", "as": "imagery"}]},
             {"name": "other", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "town", "from": "other", "image": null, "count": 2, "footprint_m": [200, 200]}],
    "methods": ["roads"]})",
                                           folder.path());
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  EXPECT_TRUE(bench::run(manifest, options).empty());
  EXPECT_THAT(left_out, ::testing::ElementsAre(HasSubstr("UTM zones")));
}

TEST_F(BenchRun, GivesTheSameAnswersWithAnotherNumberOfJobsAndAFoundMap) {
  const auto first = run(kImageQueries, R"("roads", "sift")");
  options.jobs = 1;
  options.limit = 2;
  const auto second = run(kImageQueries, R"("roads", "sift")");
  for (std::size_t method = 0; method < 2; ++method) {
    ASSERT_EQ(second[method].outcomes.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(first[method].outcomes[i].error_m, second[method].outcomes[i].error_m)
          << to_string(first[method].method);
      EXPECT_EQ(first[method].outcomes[i].answer.probability, second[method].outcomes[i].answer.probability);
    }
  }
}

TEST_F(BenchRun, AsksTheOtherSetsWhereAFootprintFitsNowhere) {
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  const auto results = run(
      std::string(R"({"map": "town", "image": "town.png", "count": 1, "footprint_m": [2000, 100]}, )") + kImageQueries,
      "\"roads\"");
  EXPECT_THAT(left_out, ::testing::ElementsAre(HasSubstr("2000 x 100 m")));
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].outcomes.size(), 3U);
  EXPECT_EQ(to_json(results[0])["set"], 2) << "of the manifest";
}

TEST_F(BenchRun, AsksTheOtherSetsWhereTheFileOfOneIsMissing) {
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  const auto results = run(std::string(R"({"map": "town", "frames": "lost.csv"}, )") + kImageQueries, "\"roads\"");
  EXPECT_THAT(left_out, ::testing::ElementsAre(HasSubstr("lost.csv")));
  EXPECT_EQ(results.size(), 1U);
}

TEST_F(BenchRun, SaysThatKeypointsCannotBeComparedWithAMapWithoutImagery) {
  std::vector<std::string> left_out;
  options.left_out = [&](const std::string& why) { left_out.push_back(why); };
  const auto results = bench::run(parse_manifest(R"({
    "maps": [{"name": "drawn", "sources": [{"as": "invented", "seed": 3, "side_m": 800}]}],
    "queries": [{"map": "drawn", "image": null, "count": 2, "footprint_m": [300, 300]}],
    "methods": ["sift", "orb"]})",
                                                 folder.path()),
                                  options);
  EXPECT_TRUE(results.empty());
  EXPECT_THAT(left_out, ::testing::ElementsAre(HasSubstr("'drawn' has none")));
}

TEST_F(BenchRun, LooksAtNothingThatIsPaintedWithoutBeingMarked) {
  cv::Mat picture = cv::imread(folder / "town.png");
  picture.colRange(0, 320).setTo(cv::Scalar::all(255));
  cv::imwrite(folder / "painted.png", picture);
  std::filesystem::copy_file(folder / "town.pgw", folder / "painted.pgw");
  std::filesystem::copy_file(folder / "town.png.aux.xml", folder / "painted.png.aux.xml");
  const auto results =
      run(R"({"map": "town", "image": "painted.png", "count": 6, "footprint_m": [200, 200]})", "\"roads\"");
  ASSERT_EQ(results.at(0).outcomes.size(), 6U);
  for (const Outcome& outcome : results[0].outcomes) {
    const GridPoint at = UtmZone::from_epsg(32634).value().project(outcome.truth.value().position);
    EXPECT_GT(at.east_m, 400'000 + 320 + 100);
  }
}

TEST_F(BenchRun, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  options.maps.stop = stop.get_token();
  EXPECT_THROW(run(kImageQueries, "\"roads\""), Interrupted);
}

}  // namespace
}  // namespace roadfix::bench
