#include "core/detect/rectify.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "tests/core/detect/level_camera.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

using testing::kFrame;
using testing::level_camera;

/// Of checkered ground, right and back of the nadir.
bool is_dark(cv::Point2d ground, double side_m) {
  return (static_cast<int>(std::floor(ground.x / side_m)) + static_cast<int>(std::floor(ground.y / side_m))) % 2 == 0;
}

/// A frame whose pixels say which ground they see, painted through the independent ground_of.
cv::Mat checkered(const FrameCamera& camera, double side_m) {
  cv::Mat frame(kFrame, CV_8UC1);
  for (int y = 0; y < frame.rows; ++y) {
    for (int x = 0; x < frame.cols; ++x) {
      const auto ground = ground_of(camera, *lens_of(camera, kFrame).ray_of({x + 0.5, y + 0.5}));
      frame.at<uchar>(y, x) = ground && is_dark(*ground, side_m) ? 0 : 255;
    }
  }
  return frame;
}

TEST(Rectify, PutsTheGroundBackInPlace) {
  FrameCamera camera = level_camera();
  camera.pitch = Angle::degrees(12);
  camera.roll = Angle::degrees(-7);
  // The frame's pixels are 0.32 m: for 1 m those of three by three are averaged.
  for (const double gsd_m : {0.5, 1.0}) {
    const double side_m = 40.0 * gsd_m;
    const GroundView view = rectify(checkered(camera, side_m), {}, camera, {gsd_m, 400, 1e7});
    int right = 0;
    int seen = 0;
    for (int y = 0; y < view.image.pixels.rows; ++y) {
      for (int x = 0; x < view.image.pixels.cols; ++x) {
        if (view.image.observed.at<uchar>(y, x) == 0) continue;
        const bool dark = is_dark(gsd_m * (cv::Point2d(x + 0.5, y + 0.5) - view.nadir_px), side_m);
        right += dark == (view.image.pixels.at<uchar>(y, x) < 128);
        ++seen;
      }
    }
    EXPECT_GT(seen * gsd_m * gsd_m, 25'000.0) << gsd_m;
    EXPECT_GT(static_cast<double>(right) / seen, 0.97) << gsd_m;  // edges of the squares are half a pixel wide
  }
}

TEST(Rectify, ObservesNoGroundThatTheFrameShowsWhereItWasNotObservedItself) {
  const cv::Mat frame(kFrame, CV_8UC1, cv::Scalar(90));
  cv::Mat observed(kFrame, CV_8UC1, cv::Scalar(255));
  observed.colRange(0, kFrame.width / 2).setTo(0);
  for (const double gsd_m : {0.25, 1.0}) {
    const GroundView view = rectify(frame, observed, level_camera(), {gsd_m, 400, 1e7});
    const int nadir = static_cast<int>(std::lround(view.nadir_px.x));
    ASSERT_NEAR(nadir * gsd_m, 100.0, 1.0);
    const int clear = 3;  // pixels, of the edge between both
    EXPECT_EQ(cv::countNonZero(view.image.observed.colRange(0, nadir - clear)), 0) << gsd_m;
    const cv::Mat right = view.image.observed.colRange(nadir + clear, view.image.observed.cols - clear);
    EXPECT_GT(cv::countNonZero(right), 0.95 * static_cast<double>(right.total())) << gsd_m;
  }
}

TEST(Rectify, LeavesCornersOutsideTheFrameUnobserved) {
  FrameCamera camera = level_camera();
  camera.pitch = Angle::degrees(30);
  const GroundView view = rectify(cv::Mat(kFrame, CV_8UC3, cv::Scalar::all(90)), {}, camera, {1.0, 1000, 1e7});
  EXPECT_EQ(view.image.observed.at<uchar>(view.image.observed.rows - 1, 0),
            0);  // the near edge is shorter than the far one
  EXPECT_GT(cv::countNonZero(view.image.observed), 10'000);
}

TEST(Rectify, WithTheHorizonInViewOnlyTheRangeIsObserved) {
  FrameCamera camera = level_camera();
  camera.pitch = Angle::degrees(75);
  const GroundView view = rectify(cv::Mat(kFrame, CV_8UC3, cv::Scalar::all(90)), {}, camera, {1.0, 500, 1e7});
  double farthest_m = 0.0;
  for (int y = 0; y < view.image.observed.rows; ++y) {
    for (int x = 0; x < view.image.observed.cols; ++x) {
      if (view.image.observed.at<uchar>(y, x) == 0) continue;
      farthest_m = std::max(farthest_m, std::hypot(x + 0.5 - view.nadir_px.x, y + 0.5 - view.nadir_px.y));
    }
  }
  EXPECT_NEAR(farthest_m, 500.0, 1.0);
}

TEST(Rectify, TellsThatPitchCountsFromStraightDown) {
  const cv::Mat frame(kFrame, CV_8UC3, cv::Scalar::all(90));
  for (const double pitch : {-90.0, -85.0, 90.0}) {
    FrameCamera camera = level_camera();
    camera.pitch = Angle::degrees(pitch);
    EXPECT_THAT(testing::message_of([&] {
                  rectify(frame, {}, camera, {0.5, 500, 1e7});
                }),
                ::testing::HasSubstr("measured from straight down"))
        << pitch;
  }
}

// Frames of 12 megapixels show decimetres: stripes that fine must not come out as coarse ones.
TEST(Rectify, AveragesPixelsFinerThanTheGround) {
  cv::Mat stripes(kFrame, CV_8UC1);
  for (int x = 0; x < stripes.cols; ++x) stripes.col(x).setTo(x % 2 == 0 ? 0 : 255);
  const GroundView view = rectify(stripes, {}, level_camera(), {5.1 * 200.0 / 640, 400, 1e7});
  const cv::Mat inner = view.image.pixels(cv::Rect(2, 2, view.image.pixels.cols - 4, view.image.pixels.rows - 4));
  double low = 0.0;
  double high = 0.0;
  cv::minMaxLoc(inner, &low, &high);
  EXPECT_GT(low, 90.0);
  EXPECT_LT(high, 165.0);
  EXPECT_GT(view.image.pixels.cols, 120);
}

/// A ray in units of the focal length from the principal point, by the equations of OpenCV's manual.
cv::Point2d bent(const FrameCamera& camera, cv::Point2d ray) {
  const std::vector<double>& k = camera.distortion;
  const auto [x, y] = std::pair(ray.x, ray.y);
  const double r = std::hypot(x, y);
  if (camera.lens == LensModel::kFisheye) {
    const double t = std::atan(r);
    const double outwards =
        t * (1 + k[0] * std::pow(t, 2) + k[1] * std::pow(t, 4) + k[2] * std::pow(t, 6) + k[3] * std::pow(t, 8));
    return r > 0.0 ? ray * (outwards / r) : cv::Point2d();
  }
  const double radial = 1 + k[0] * r * r + k[1] * std::pow(r, 4) + k[4] * std::pow(r, 6);
  return {x * radial + 2 * k[2] * x * y + k[3] * (r * r + 2 * x * x),
          y * radial + k[2] * (r * r + 2 * y * y) + 2 * k[3] * x * y};
}

/// Places of the ground, right and back of the nadir, where the frame is given a white dot.
std::vector<cv::Point2d> dotted(const FrameCamera& camera, cv::Mat& frame) {
  constexpr double kRadius = 2.0;
  constexpr double kMargin = 3.0 * kRadius;
  constexpr int kShift = 6;  // fractions of a pixel
  const auto fractions = [](double length) { return static_cast<int>(std::lround(length * (1 << kShift))); };
  const cv::Rect2d inner(kMargin, kMargin, frame.cols - 2 * kMargin, frame.rows - 2 * kMargin);
  std::vector<cv::Point2d> dots;
  for (double right = -140.0; right <= 140.0; right += 20.0) {
    for (double back = -140.0; back <= 140.0; back += 20.0) {
      const cv::Point2d pixel =
          *camera.focal_px * bent(camera, cv::Point2d(right, back) / camera.agl_m) + *camera.principal_px;
      if (!inner.contains(pixel)) continue;
      cv::circle(frame, {fractions(pixel.x), fractions(pixel.y)}, fractions(kRadius), cv::Scalar(255), cv::FILLED,
                 cv::LINE_AA, kShift);
      dots.emplace_back(right, back);
    }
  }
  return dots;
}

/// How far the white around a place of the ground lies from it, in metres; at most 8.
double miss_m(const GroundView& view, cv::Point2d place) {
  const double gsd_m = view.image.gsd_m;
  const cv::Point2d at = place / gsd_m + view.nadir_px;
  const int reach = static_cast<int>(8.0 / gsd_m);
  const cv::Rect box = cv::Rect(static_cast<int>(at.x) - reach, static_cast<int>(at.y) - reach, 2 * reach, 2 * reach) &
                       cv::Rect({}, view.image.pixels.size());
  const cv::Moments white = cv::moments(view.image.pixels(box));
  if (white.m00 == 0.0) return 8.0;
  const cv::Point2d centre(box.x + white.m10 / white.m00 + 0.5, box.y + white.m01 / white.m00 + 0.5);
  return cv::norm(centre - at) * gsd_m;
}

TEST(Rectify, TakesTheDistortionOfTheLensOut) {
  FrameCamera wide = level_camera();
  wide.horizontal_fov.reset();
  wide.focal_px = 300.0;
  wide.principal_px = {331.0, 228.0};
  wide.distortion = {-0.21, 0.04, 0.002, -0.003, -0.002};
  FrameCamera fisheye = wide;
  fisheye.lens = LensModel::kFisheye;
  fisheye.distortion = {-0.03, 0.004, -0.002, 0.0003};
  for (const FrameCamera& camera : {wide, fisheye}) {
    cv::Mat frame(kFrame, CV_8UC1, cv::Scalar(0));
    const std::vector<cv::Point2d> dots = dotted(camera, frame);
    EXPECT_GT(dots.size(), 80U);
    const auto in_place = [&](const GroundView& seen) {
      return std::ranges::count_if(dots, [&](const cv::Point2d& dot) { return miss_m(seen, dot) < 0.3; });
    };
    FrameCamera ideal = camera;
    ideal.lens = LensModel::kPerspective;
    ideal.distortion.clear();
    const auto all = static_cast<std::ptrdiff_t>(dots.size());
    EXPECT_EQ(in_place(rectify(frame, {}, camera, {0.25, 400, 1e7})), all);
    EXPECT_LT(in_place(rectify(frame, {}, ideal, {0.25, 400, 1e7})), all / 4);
  }
}

TEST(Rectify, DoesNotObserveWhereALensHasFoldedBack) {
  FrameCamera camera = level_camera();
  camera.horizontal_fov.reset();
  camera.focal_px = 320.0;
  camera.distortion = {-0.5, 0, 0, 0};  // r - r^3 / 2 grows up to r = 0.816
  const GroundView view = rectify(cv::Mat(kFrame, CV_8UC1, cv::Scalar(90)), {}, camera, {0.5, 400, 1e7});
  int seen = 0;
  for (int y = 0; y < view.image.observed.rows; ++y) {
    for (int x = 0; x < view.image.observed.cols; ++x) {
      if (view.image.observed.at<uchar>(y, x) == 0) continue;
      ASSERT_LE(std::hypot(x + 0.5 - view.nadir_px.x, y + 0.5 - view.nadir_px.y) * 0.5, 82.0);
      ++seen;
    }
  }
  EXPECT_GT(seen, 40'000);
}

TEST(Rectify, RefusesWhatCannotBe) {
  const cv::Mat frame(kFrame, CV_8UC3, cv::Scalar::all(90));
  const auto refusal_with = [&](auto change) {
    FrameCamera camera = level_camera();
    change(camera);
    return testing::code_of([&] { rectify(frame, {}, camera, {0.5, 500, 1e7}); });
  };
  EXPECT_EQ(refusal_with([](auto& c) { c.agl_m = -1; }), "frame-camera");
  EXPECT_EQ(refusal_with([](auto& c) { c.agl_m = std::nan(""); }), "frame-camera");
  EXPECT_EQ(refusal_with([](auto& c) { c.horizontal_fov = Angle::degrees(180); }), "frame-camera");
  EXPECT_EQ(refusal_with([](auto& c) { c.horizontal_fov.reset(); }), "frame-camera");
  EXPECT_EQ(refusal_with([](auto& c) { c.distortion = {-0.1, 0, 0, 0}; }), "frame-camera") << "no focal length";
  EXPECT_EQ(refusal_with([](auto& c) { c.pitch = Angle::degrees(170); }), "frame-sees-no-ground");
  EXPECT_EQ(testing::code_of([&] { rectify(frame, {}, level_camera(), {0.001, 500, 1e7}); }), "ground-too-large");
}

TEST(Rectify, RefusesWhatIsTooLongToBeWarped) {
  const cv::Mat frame(4, 33'000, CV_8UC1, cv::Scalar(90));
  FrameCamera camera = level_camera();
  camera.horizontal_fov = Angle::degrees(100);
  camera.agl_m = 5000;
  const auto code_at = [&](const cv::Mat& picture, double gsd_m) {
    return testing::code_of([&] { rectify(picture, {}, camera, {gsd_m, 15'000, 1e9}); });
  };
  EXPECT_EQ(code_at(frame, 0.5), "image-too-large");
  EXPECT_EQ(code_at(frame, 2.0), "no error") << "averaged first, it is shorter";
  EXPECT_EQ(code_at(frame.colRange(0, 3000), 0.3), "ground-too-large");
}

}  // namespace
}  // namespace roadfix
