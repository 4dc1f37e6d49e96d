// roadfix pairs as somebody meets it who trains a network on a city of their own.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <string>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;

class PairsCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(roadfix("world " + path("town") + " --seed 3 --size-km 0.6x0.6 --frames 0").code, 0);
  }
  ProgramResult roadfix(const std::string& arguments) const { return testing::run_program(folder.path(), arguments); }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  ProgramResult pairs(const std::string& imagery, const std::string& roads, const std::string& into,
                      const std::string& options = "") const {
    return roadfix("pairs " + path(imagery) + " " + path(roads) + " " + path(into) + " " + options);
  }
  std::set<std::string> names_in(const std::string& part) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder / part)) names.insert(entry.path().filename());
    return names;
  }
  const testing::TemporaryFolder folder;
};

TEST_F(PairsCommand, WritesPicturesAndMasksOfEqualNamesAndSaysTheirScale) {
  const ProgramResult result = pairs("town/pre.tif", "town/roads.geojson", "mine", "--side-px 512");
  ASSERT_EQ(result.code, 0) << result.err;
  const std::set<std::string> names = names_in("mine/images");
  EXPECT_EQ(names, names_in("mine/masks"));
  EXPECT_GE(names.size(), 4U);
  EXPECT_THAT(result.out, HasSubstr(std::to_string(names.size()) + " pairs in pixels of 0.5 m"));
  double road = 0.0;
  double seen = 0.0;
  for (const std::string& name : names) {
    const cv::Mat picture = cv::imread((folder / "mine/images" / name).string(), cv::IMREAD_COLOR);
    const cv::Mat mask = cv::imread((folder / "mine/masks" / name).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_EQ(picture.size(), cv::Size(512, 512));
    ASSERT_EQ(mask.size(), picture.size());
    road += cv::countNonZero(mask);
    cv::Mat black;
    cv::inRange(picture, cv::Scalar(0, 0, 0), cv::Scalar(0, 0, 0), black);
    seen += static_cast<double>(black.total()) - cv::countNonZero(black);
  }
  EXPECT_GT(road / seen, 0.05);
  EXPECT_LT(road / seen, 0.4);
  const nlohmann::json set = nlohmann::json::parse(testing::text_of(folder / "mine/pairs.json"))["sets"][0];
  EXPECT_EQ(set["gsd_m"], 0.5);
  EXPECT_EQ(set["nodata"], "black");
}

TEST_F(PairsCommand, NamesTheSetAfterItsFolderHoweverThatIsWritten) {
  for (const std::string written : {"mine", "mine/", "mine/."}) {
    ASSERT_EQ(pairs("town/pre.tif", "town/roads.geojson", written).code, 0);
    EXPECT_EQ(nlohmann::json::parse(testing::text_of(folder / "mine/pairs.json"))["sets"][0]["name"], "mine")
        << written;
    std::filesystem::remove_all(folder / "mine");
  }
}

TEST_F(PairsCommand, AddsAnotherDayUnderNamesThatSayTheSameGround) {
  ASSERT_EQ(pairs("town/pre.tif", "town/roads.geojson", "mine", "--name city_pre").code, 0);
  const std::set<std::string> before = names_in("mine/images");
  ASSERT_EQ(pairs("town/post.tif", "town/roads.geojson", "mine", "--name city_post").code, 0);
  std::set<std::string> both = before;
  for (std::string name : before) both.insert(name.replace(name.find("_pre"), 4, "_post"));
  EXPECT_EQ(names_in("mine/images"), both);
}

TEST_F(PairsCommand, RefusesWhatWouldMixSquaresOrHoldNothing) {
  ASSERT_EQ(pairs("town/pre.tif", "town/roads.geojson", "mine").code, 0);
  for (const char* another : {"--gsd 1", "--side-px 512"}) {
    const ProgramResult cut_otherwise = pairs("town/pre.tif", "town/roads.geojson", "mine", another);
    EXPECT_EQ(cut_otherwise.code, 1) << another;
    EXPECT_THAT(cut_otherwise.err, HasSubstr("[pairs-of-another-cut]")) << another;
  }

  std::ofstream(folder / "far.geojson")
      << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
      << R"({"type":"LineString","coordinates":[[38.5,37.9],[38.51,37.9]]}}]})";
  const ProgramResult elsewhere = pairs("town/pre.tif", "far.geojson", "other");
  EXPECT_EQ(elsewhere.code, 1);
  EXPECT_THAT(elsewhere.err, HasSubstr("[pairs-without-ground]"));
  EXPECT_THAT(elsewhere.err, Not(HasSubstr("0/0"))) << "no progress of no work";
  EXPECT_FALSE(std::filesystem::exists(folder / "other"));

  const ProgramResult width = pairs("town/pre.tif", "town/pre.tif", "other", "--width 5");
  EXPECT_THAT(width.err, HasSubstr("[option-without-effect]"));
}

TEST_F(PairsCommand, NotesImageryThatLooksLikeRoads) {
  cv::Mat mask(64, 64, CV_8UC1, cv::Scalar(0));
  mask.row(30).setTo(255);
  cv::imwrite(path("mask.png"), mask);
  std::ofstream(folder / "mask.pgw") << "1\n0\n0\n-1\n264000\n4183000\n";
  const ProgramResult result = pairs("mask.png", "town/roads.geojson", "mine", "--crs EPSG:32637");
  EXPECT_THAT(result.err, HasSubstr("note: " + path("mask.png") + ": its values are 0 and 255, as those of a mask"));
}

TEST_F(PairsCommand, AsksForSmallerSquaresWhereLittleOfEachIsSeen) {
  const ProgramResult little = pairs("town/pre.tif", "town/roads.geojson", "mine", "--gsd 2 --side-px 4096");
  EXPECT_EQ(little.code, 1);
  EXPECT_THAT(little.err, HasSubstr("less than 2 % of each square of 8192 m"));
  EXPECT_EQ(pairs("town/pre.tif", "town/roads.geojson", "mine", "--gsd 2 --side-px 256").code, 0);
}

}  // namespace
}  // namespace roadfix
