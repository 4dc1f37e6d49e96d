#include "core/detect/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/core/detect/level_camera.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

using testing::kFrame;
using testing::level_camera;

TEST(Frame, WithPixelsWiderThanRoadsOrFinerThanAnyIsRefused) {
  const auto code = [](double gsd_m) { return testing::code_of([&] { require_roads_visible(gsd_m); }); };
  EXPECT_EQ(code(kCoarsestGsdM), "no error");
  EXPECT_EQ(code(1.01 * kCoarsestGsdM), "frame-too-coarse");
  EXPECT_EQ(code(kFinestGsdM), "no error");
  EXPECT_EQ(code(0.99 * kFinestGsdM), "frame-too-fine");
}

/// Works best at pixels of half a metre.
class HalfMetreDetector : public RoadDetector {
 public:
  CellArray detect(const GroundImage&, double, std::uint64_t, const std::stop_token&) const override { return {}; }
  double preferred_gsd_m() const override { return 0.5; }
  double halo_m() const override { return 0.0; }
  std::string name() const override { return "none"; }
  std::string settings() const override { return {}; }
};

TEST(GroundSeen, HasThePixelsOfTheFrameUnlessTheDetectorMakesNoUseOfThem) {
  const HalfMetreDetector detector;
  const FramePixels frame{cv::Mat(kFrame, CV_8UC3, cv::Scalar::all(90)), cv::Mat(kFrame, CV_8UC1, cv::Scalar(255))};
  FrameCamera camera = level_camera();
  const auto gsd_at = [&](double agl_m) {
    camera.agl_m = agl_m;
    return ground_seen(frame, camera, detector, 1e7).image.gsd_m;
  };
  EXPECT_DOUBLE_EQ(gsd_at(100.0), 200.0 / 640);
  EXPECT_DOUBLE_EQ(gsd_at(20.0), 0.25);
  EXPECT_EQ(testing::code_of([&] { gsd_at(2000.0); }), "frame-too-coarse");
}

/// How far ahead a camera sees that has the horizon in the frame.
double reach_m(double agl_m, std::optional<Angle> attitude_sigma = {}) {
  cv::Mat pixels(kFrame, CV_8UC1);
  cv::randu(pixels, 0, 255);
  FrameCamera camera = level_camera();
  camera.pitch = Angle::degrees(60);
  camera.agl_m = agl_m;
  camera.attitude_sigma = attitude_sigma;
  const HalfMetreDetector detector;
  const GroundView view = ground_seen({pixels, cv::Mat(kFrame, CV_8UC1, cv::Scalar(255))}, camera, detector, 4e7);
  EXPECT_LE(view.image.pixels.cols * view.image.gsd_m, 2.0 * view.nadir_px.y * view.image.gsd_m + 2.0);
  return view.nadir_px.y * view.image.gsd_m;
}

/// How much more that is than the ground below.
double moved_m(double far_m, double agl_m, Angle pitch) {
  return agl_m * (std::tan(std::atan(far_m / agl_m) + pitch.radians()) - std::tan(pitch.radians())) - far_m;
}

TEST(GroundSeen, ReachesAsFarAsADegreeOfPitchMovesItHardlyMoreThanTheGroundBelow) {
  for (const double agl_m : {30.0, 60.0, 120.0}) {
    EXPECT_NEAR(moved_m(reach_m(agl_m), agl_m, Angle::degrees(1.0)), 10.0, 1.0) << agl_m;
  }
}

TEST(GroundSeen, ReachesFartherTheBetterTheAttitudeIsKnown) {
  for (const double sigma_deg : {0.5, 2.0}) {
    const Angle sigma = Angle::degrees(sigma_deg);
    EXPECT_NEAR(moved_m(reach_m(90.0, sigma), 90.0, sigma), 10.0, 1.0) << sigma_deg;
  }
}

TEST(GroundSeen, ReachesFiveHeightsAtMostAndOneAndAHalfAtLeast) {
  EXPECT_NEAR(reach_m(120.0, Angle::degrees(0.1)), 600.0, 2.0);
  EXPECT_NEAR(reach_m(60.0, Angle::degrees(10.0)), 90.0, 1.0);
  EXPECT_NEAR(reach_m(15.0), 75.0, 1.0);
  EXPECT_NEAR(reach_m(400.0), 600.0, 2.0);
}

TEST(GroundSeen, HasNoPaintedBorderAndNoBlankGround) {
  const HalfMetreDetector detector;
  cv::Mat pixels(400, 400, CV_8UC3);
  cv::theRNG().state = 3;
  cv::randu(pixels, 20, 230);
  pixels.colRange(0, 10).setTo(cv::Scalar::all(255));                 // 5 m at the left edge
  pixels(cv::Rect(200, 200, 80, 80)).setTo(cv::Scalar(200, 90, 40));  // 40 m within
  const FramePixels frame{pixels, cv::Mat(pixels.size(), CV_8UC1, cv::Scalar(255))};
  const GroundImage seen = ground_seen(frame, StraightDown{0.5}, detector, 1e7).image;
  EXPECT_EQ(seen.gsd_m, 0.5);
  EXPECT_EQ(cv::countNonZero(seen.observed.colRange(0, 10)), 0);
  EXPECT_EQ(cv::countNonZero(seen.observed(cv::Rect(200, 200, 80, 80))), 0);
  EXPECT_GT(cv::countNonZero(seen.observed), 400 * 390 - 100 * 100);
  EXPECT_EQ(cv::countNonZero(frame.observed), 400 * 400) << "the frame itself stays as it was";
}

}  // namespace
}  // namespace roadfix
