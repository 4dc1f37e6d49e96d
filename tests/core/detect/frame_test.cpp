#include "core/detect/frame.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/units/error.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

const cv::Size kFrame(640, 480);

FrameCamera level() {
  FrameCamera camera;
  camera.horizontal_fov = Angle::degrees(90);
  camera.agl_m = 100;
  return camera;
}

TEST(GroundOf, LevelCameraLooksStraightDown) {
  // 90 degrees across: half the columns see 100 m at 100 m altitude.
  const auto corner = ground_of(level(), kFrame, {640, 0});
  EXPECT_NEAR(corner->x, 100, 1e-9);
  EXPECT_NEAR(corner->y, -75, 1e-9);
  EXPECT_NEAR(nominal_gsd_m(level(), kFrame), 200.0 / 640, 1e-12);
}

// Oracle: angles of the ray in the plane of the tilt.
TEST(GroundOf, PitchLooksForwardAndRollLooksLeft) {
  FrameCamera camera = level();
  camera.pitch = Angle::degrees(20);
  EXPECT_NEAR(ground_of(camera, kFrame, {320, 240})->y, -100 * std::tan(20 * M_PI / 180), 1e-9);
  EXPECT_NEAR(ground_of(camera, kFrame, {320, 0})->y, -100 * std::tan(20 * M_PI / 180 + std::atan(0.75)), 1e-9);
  camera = level();
  camera.roll = Angle::degrees(10);
  EXPECT_NEAR(ground_of(camera, kFrame, {320, 240})->x, -100 * std::tan(10 * M_PI / 180), 1e-9);
  EXPECT_NEAR(ground_of(camera, kFrame, {640, 240})->x, 100 * std::tan((45 - 10) * M_PI / 180), 1e-9);
}

// Oracle: how far the ground on the optical axis moves when the camera turns by a hundredth of the angle.
TEST(NadirSigma, IsWhatASmallErrorOfPitchOrRollMovesTheGroundInViewBy) {
  const cv::Point2d middle(320, 240);
  const Angle little = Angle::degrees(0.01);
  for (const double pitch_deg : {0.0, 30.0, -45.0}) {
    FrameCamera camera = level();
    camera.pitch = Angle::degrees(pitch_deg);
    FrameCamera turned = camera;
    turned.pitch += little;
    const double moved_m = std::abs(ground_of(turned, kFrame, middle)->y - ground_of(camera, kFrame, middle)->y);
    EXPECT_NEAR(nadir_sigma_m(camera, Angle::degrees(1.0)), 100.0 * moved_m, 0.002 * 100.0 * moved_m) << pitch_deg;
  }
  FrameCamera rolled = level();
  rolled.roll = Angle::degrees(60.0);
  EXPECT_NEAR(nadir_sigma_m(rolled, Angle::degrees(1.0)), 4.0 * nadir_sigma_m(level(), Angle::degrees(1.0)), 1e-9);
  rolled.roll = Angle::degrees(90.0);
  EXPECT_TRUE(std::isfinite(nadir_sigma_m(rolled, Angle::degrees(1.0))));
}

TEST(GroundOf, NothingLiesAboveTheHorizon) {
  FrameCamera camera = level();
  camera.pitch = Angle::degrees(80);
  EXPECT_FALSE(ground_of(camera, kFrame, {320, 0}));
  EXPECT_TRUE(ground_of(camera, kFrame, {320, 479}));
}

/// A frame whose pixels say which ground they see, painted through the independent ground_of.
cv::Mat checkered(const FrameCamera& camera, double side_m) {
  cv::Mat frame(kFrame, CV_8UC1);
  for (int y = 0; y < frame.rows; ++y) {
    for (int x = 0; x < frame.cols; ++x) {
      const auto ground = ground_of(camera, kFrame, {x + 0.5, y + 0.5});
      const bool dark =
          ground &&
          (static_cast<int>(std::floor(ground->x / side_m)) + static_cast<int>(std::floor(ground->y / side_m))) % 2 ==
              0;
      frame.at<uchar>(y, x) = dark ? 0 : 255;
    }
  }
  return frame;
}

TEST(Rectify, PutsTheGroundBackInPlace) {
  FrameCamera camera = level();
  camera.pitch = Angle::degrees(12);
  camera.roll = Angle::degrees(-7);
  constexpr double kSide = 20.0;
  const GroundView view = rectify(checkered(camera, kSide), {}, camera, 0.5, 400, 1e7);
  int right = 0;
  int seen = 0;
  for (int y = 0; y < view.image.pixels.rows; ++y) {
    for (int x = 0; x < view.image.pixels.cols; ++x) {
      if (view.image.observed.at<uchar>(y, x) == 0) continue;
      const double ground_x = (x + 0.5 - view.nadir_px.x) * 0.5;
      const double ground_y = (y + 0.5 - view.nadir_px.y) * 0.5;
      const bool dark =
          (static_cast<int>(std::floor(ground_x / kSide)) + static_cast<int>(std::floor(ground_y / kSide))) % 2 == 0;
      right += dark == (view.image.pixels.at<uchar>(y, x) < 128);
      ++seen;
    }
  }
  EXPECT_GT(seen, 100'000);
  EXPECT_GT(static_cast<double>(right) / seen, 0.97);  // edges of the squares are half a pixel wide
}

TEST(Rectify, LeavesCornersOutsideTheFrameUnobserved) {
  FrameCamera camera = level();
  camera.pitch = Angle::degrees(30);
  const GroundView view = rectify(cv::Mat(kFrame, CV_8UC3, cv::Scalar::all(90)), {}, camera, 1.0, 1000, 1e7);
  EXPECT_EQ(view.image.observed.at<uchar>(view.image.observed.rows - 1, 0),
            0);  // the near edge is shorter than the far one
  EXPECT_GT(cv::countNonZero(view.image.observed), 10'000);
}

TEST(Rectify, WithTheHorizonInViewOnlyTheRangeIsObserved) {
  FrameCamera camera = level();
  camera.pitch = Angle::degrees(75);
  const GroundView view = rectify(cv::Mat(kFrame, CV_8UC3, cv::Scalar::all(90)), {}, camera, 1.0, 500, 1e7);
  for (int y = 0; y < view.image.observed.rows; ++y) {
    for (int x = 0; x < view.image.observed.cols; ++x) {
      if (view.image.observed.at<uchar>(y, x) == 0) continue;
      ASSERT_LE(std::hypot(x + 0.5 - view.nadir_px.x, y + 0.5 - view.nadir_px.y), 501.0);
    }
  }
}

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
  std::string describe() const override { return "none"; }
};

TEST(GroundSeen, HasThePixelsOfTheFrameUnlessTheDetectorMakesNoUseOfThem) {
  const HalfMetreDetector detector;
  const GroundImage frame{cv::Mat(kFrame, CV_8UC3, cv::Scalar::all(90)), cv::Mat(kFrame, CV_8UC1, cv::Scalar(255))};
  FrameCamera camera = level();
  const auto gsd_at = [&](double agl_m) {
    camera.agl_m = agl_m;
    return ground_seen(frame, camera, detector, 1e7).image.gsd_m;
  };
  EXPECT_DOUBLE_EQ(gsd_at(100.0), 200.0 / 640);
  EXPECT_DOUBLE_EQ(gsd_at(20.0), 0.25);
  EXPECT_EQ(testing::code_of([&] { gsd_at(2000.0); }), "frame-too-coarse");
}

TEST(Rectify, TellsThatPitchCountsFromStraightDown) {
  const cv::Mat frame(kFrame, CV_8UC3, cv::Scalar::all(90));
  for (const double pitch : {-90.0, -85.0, 90.0}) {
    FrameCamera camera = level();
    camera.pitch = Angle::degrees(pitch);
    EXPECT_THAT(testing::message_of([&] { rectify(frame, {}, camera, 0.5, 500, 1e7); }),
                ::testing::HasSubstr("measured from straight down"))
        << pitch;
  }
}

TEST(Rectify, RefusesWhatCannotBe) {
  const cv::Mat frame(kFrame, CV_8UC3, cv::Scalar::all(90));
  const auto with = [&](auto change) {
    FrameCamera camera = level();
    change(camera);
    return [=] { rectify(frame, {}, camera, 0.5, 500, 1e7); };
  };
  EXPECT_THROW(with([](auto& c) { c.agl_m = -1; })(), InvalidInput);
  EXPECT_THROW(with([](auto& c) { c.agl_m = std::nan(""); })(), InvalidInput);
  EXPECT_THROW(with([](auto& c) { c.horizontal_fov = Angle::degrees(180); })(), InvalidInput);
  EXPECT_THROW(with([](auto& c) { c.horizontal_fov.reset(); })(), InvalidInput);
  EXPECT_THROW(with([](auto& c) { c.pitch = Angle::degrees(170); })(), InvalidInput);  // looks at the sky
  EXPECT_THROW(rectify(frame, {}, level(), 0.001, 500, 1e7), LimitExceeded);
}

}  // namespace
}  // namespace roadfix
