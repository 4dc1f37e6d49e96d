// Sources of one town that lie beside each other: what ingest, info and fix say of it.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "core/grid/cell.hpp"
#include "tests/e2e/ingest_fixture.hpp"
#include "tests/support/street_map.hpp"

namespace roadfix {
namespace {

using ::testing::AllOf;
using testing::ChildResult;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::run_child;

class IngestShift : public testing::IngestCommand {
 protected:
  /// The town as a raster of roads that lies so far too far east.
  std::string town(const std::string& name, double east_m) const {
    if (std::filesystem::exists(folder / name)) return folder / name;  // written anew, it would be another content
    testing::RasterSpec spec{.width = kSide, .height = kSide};
    spec.transform = {400'000.0 + east_m, 2.0, 0.0, 4'200'000.0, 0.0, -2.0};
    return testing::write_raster(folder / name, spec, [&](int, int col, int row) { return streets.at(col, row); });
  }
  ChildResult ingest_town(const std::string& name, double east_m, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{town(name, east_m), "--as", "roads", "--map", map("m.gpkg")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ingest(arguments);
  }
  ChildResult roadfix(const std::vector<std::string>& arguments) const {
    return run_child(ROADFIX_PROGRAM, arguments, folder.path());
  }
  std::string info() const { return roadfix({"info", map("m.gpkg")}).out; }
  nlohmann::json sources() const {
    return nlohmann::json::parse(roadfix({"info", map("m.gpkg"), "--json"}).out)["sources"];
  }
  /// Of a frame of the middle of the town.
  nlohmann::json fix() const {
    constexpr int kFrame = 200;
    cv::Mat1b frame(kFrame, kFrame);
    for (int row = 0; row < kFrame; ++row) {
      for (int col = 0; col < kFrame; ++col) {
        frame(row, col) = streets.at((kSide - kFrame) / 2 + col, (kSide - kFrame) / 2 + row);
      }
    }
    const std::string png = folder / "frame.png";
    cv::imwrite(png, frame);
    return nlohmann::json::parse(roadfix({"fix", map("m.gpkg"), png, "--cell", "2", "--json"}).out);
  }

  static constexpr int kSide = 600;
  const CellArray streets = testing::street_map(5, {2.0, {0, 0}, kSide, kSide}).cells;
};

TEST_F(IngestShift, IsToldAndCountsUntilItIsCured) {
  ASSERT_EQ(ingest_town("right.tif", 0.0).code, 0);
  EXPECT_THAT(info(), HasSubstr("3 m (1 sigma)"));
  const ChildResult beside = ingest_town("beside.tif", 20.0);
  EXPECT_EQ(beside.code, 0);
  EXPECT_THAT(beside.err, AllOf(HasSubstr("'beside' would fit the other sources of the map better about 20 m to the "
                                          "west"),
                                HasSubstr("count as known within 10 m (1 sigma) instead of 3 m"),
                                HasSubstr("--registration-sigma 10"), HasSubstr("'right' would fit")));
  const std::string told = info();
  EXPECT_THAT(told, AllOf(HasSubstr("10 m (1 sigma)"), HasSubstr("not the 3 m stated"), Not(HasSubstr(" 3 m (1"))));
  EXPECT_EQ(sources()[0]["shift"], nlohmann::json({{"east_m", -20.0}, {"north_m", 0.0}, {"sigma_m", 10.0}}));
  EXPECT_EQ(sources()[0]["registration_sigma_m"], 3.0);

  const ChildResult again = ingest_town("beside.tif", 20.0);
  EXPECT_THAT(again.err, AllOf(HasSubstr("'beside' would fit"), HasSubstr("'right' would fit"))) << "nothing changes";
  EXPECT_EQ(info(), told);

  const ChildResult removed = roadfix({"remove", map("m.gpkg"), "beside"});
  EXPECT_EQ(removed.code, 0) << removed.err;
  EXPECT_THAT(info(), AllOf(HasSubstr("3 m (1 sigma)"), Not(HasSubstr("stated"))));
}

TEST_F(IngestShift, IsExplainedByTheErrorThatTheUserStatesForOneOfThem) {
  ASSERT_EQ(ingest_town("right.tif", 0.0).code, 0);
  const ChildResult beside = ingest_town("beside.tif", 20.0, {"--registration-sigma", "12"});
  EXPECT_THAT(beside.err, Not(HasSubstr("would fit")));
  EXPECT_EQ(sources()[0]["registration_sigma_m"], 12.0);
  EXPECT_FALSE(sources()[1].contains("shift"));
  const ChildResult surer = ingest_town("beside.tif", 20.0, {"--registration-sigma", "1"});
  EXPECT_THAT(surer.err,
              AllOf(HasSubstr("now has position within 1 m"), HasSubstr("within 10 m (1 sigma) instead of 1 m")));
  EXPECT_EQ(sources()[0]["registration_sigma_m"], 1.0);
}

TEST_F(IngestShift, IsPartOfTheAccuracyOfAFix) {
  ASSERT_EQ(ingest_town("right.tif", 0.0).code, 0);
  const double alone_m = fix()["modes"][0]["sigma_m"][0];
  EXPECT_LT(alone_m, 6.0);
  ASSERT_EQ(ingest_town("beside.tif", 20.0).code, 0);
  EXPECT_GE(fix()["modes"][0]["sigma_m"][1], 10.0);
}

}  // namespace
}  // namespace roadfix
