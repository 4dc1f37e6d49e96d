#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "cli/bench/agreement_picture.hpp"
#include "cli/bench/match_picture.hpp"
#include "core/grid/resample.hpp"
#include "tests/support/ascii_map.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix::bench {
namespace {

using testing::from_ascii;

const cv::Vec3b kWhite(255, 255, 255);
const cv::Vec3b kBlue(255, 0, 0);
const cv::Vec3b kRed(0, 0, 255);
const cv::Vec3b kBlack(0, 0, 0);
const cv::Vec3b kGrey(90, 90, 90);

/// Streets of 2 m cells whose first cell has its outer corner at (0, 0) of the plane.
RoadGrid town() { return testing::street_map(3, {2.0, {0, 0}, 300, 300}); }

TEST(Agreement, IsWhiteWhereBothHaveRoadAndColouredWhereOneHas) {
  const cv::Mat picture = agreement(from_ascii("##..?"), from_ascii("#.#.#"));
  const cv::Vec3b expected[] = {kWhite, kBlue, kRed, kBlack, kGrey};
  for (int col = 0; col < picture.cols; ++col) EXPECT_EQ(picture.at<cv::Vec3b>(0, col), expected[col]) << col;
}

TEST(Agreement, IsDarkWhereTheMapIsSureOfNoRoadAnywhere) {
  const CellArray field(8, 8, cell_from_probability(0.02));
  const cv::Mat picture = agreement(field, field);
  EXPECT_LT(picture.at<cv::Vec3b>(4, 4)[0], 40);
}

TEST(Agreement, PutsTheMapUnderTheNadirAndNotUnderTheMiddle) {
  const RoadGrid grid = town();
  const MapView map = testing::view_of(grid);
  const GridPose pose{{300.0, -280.0}, Angle::degrees(30)};
  FeatureMap features = cut_out(grid, pose, 60, 80, 2.0);
  EXPECT_EQ(map_under(map, features, pose), features.cells);

  // The same ground seen by a UAV 20 m further on: its nadir lies 10 cells ahead of the middle.
  features.nadir.row -= 10.0;
  const GridPose ahead{
      {pose.position.east_m + 20.0 * sin(pose.heading), pose.position.north_m + 20.0 * cos(pose.heading)},
      pose.heading};
  const CellArray under = map_under(map, features, ahead);
  int alike = 0;
  for (std::size_t i = 0; i < under.cells().size(); ++i)
    alike += std::abs(under.cells()[i] - features.cells.cells()[i]) <= 1 ? 1 : 0;  // rounding of the pose
  EXPECT_EQ(alike, 60 * 80);
}

TEST(RightMatches, AreThoseWithinTheToleranceOfTheTruePlace) {
  GroundImage frame;
  frame.pixels = cv::Mat::zeros(100, 100, CV_8UC3);
  frame.gsd_m = 0.5;
  const GridPoint origin{1000.0, 2000.0};
  const GridPose east{{1100.0, 1900.0}, Angle::degrees(90)};
  // The pixel 20 m ahead and 10 m to the right of the centre: 20 m east and 10 m south of it.
  const PointMatches matches{{{69.5F, 9.5F}, {69.5F, 9.5F}, {69.5F, 9.5F}},
                             {{120.0F, 110.0F}, {120.0F, 119.0F}, {120.0F, 121.0F}}};
  EXPECT_EQ(right_matches(matches, origin, vertical_view(frame), east, 10.0), (std::vector<bool>{true, true, false}));
  // The same UAV with its camera tilted: the picture shows what is ahead, 15 m further on.
  PointMatches ahead = matches;
  for (cv::Point2f& pixel : ahead.frame_px) pixel.y += 30.0F;
  EXPECT_EQ(right_matches(ahead, origin, {frame, {50.0, 80.0}}, east, 10.0), (std::vector<bool>{true, true, false}));
}

TEST(MatchPicture, DrawsRightMatchesGreenAndWrongOnesRed) {
  Orthoimage before;
  before.image.pixels = cv::Mat(200, 200, CV_8UC1, cv::Scalar::all(128));
  before.image.observed = cv::Mat(200, 200, CV_8UC1, cv::Scalar::all(255));
  before.image.gsd_m = 1.0;
  before.north_west = {500.0, 700.0};
  GroundImage frame;
  frame.pixels = cv::Mat(80, 80, CV_8UC1, cv::Scalar::all(128));
  frame.gsd_m = 1.0;
  const GridPose truth{{600.0, 600.0}, {}};
  const auto pixels_of = [&](const PointMatches& matches, const std::optional<GridPose>& pose, bool green) {
    cv::Mat found;
    const cv::Scalar low = green ? cv::Scalar(0, 180, 0) : cv::Scalar(0, 0, 210);
    const cv::Scalar high = green ? cv::Scalar(90, 255, 90) : cv::Scalar(90, 90, 255);
    cv::inRange(match_picture(std::vector{before}, vertical_view(frame), matches, pose), low, high, found);
    return cv::countNonZero(found);
  };
  const PointMatches right{{{39.5F, 39.5F}}, {{100.0F, 100.0F}}};
  EXPECT_GT(pixels_of(right, truth, true), 100);
  EXPECT_EQ(pixels_of(right, truth, false), 0);
  EXPECT_EQ(pixels_of(right, std::nullopt, true), 0);
  EXPECT_GT(pixels_of(right, std::nullopt, false), 100);
}

}  // namespace
}  // namespace roadfix::bench
