#include "core/detect/frame_camera.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/units/error.hpp"
#include "tests/core/detect/level_camera.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix {
namespace {

using testing::kFrame;
using testing::level_camera;

std::optional<cv::Point2d> ground_at(const FrameCamera& camera, cv::Point2d pixel) {
  return ground_of(camera, *lens_of(camera, kFrame).ray_of(pixel));
}

TEST(GroundOf, LevelCameraLooksStraightDown) {
  // 90 degrees across: half the columns see 100 m at 100 m altitude.
  const auto corner = ground_at(level_camera(), {640, 0});
  EXPECT_NEAR(corner->x, 100, 1e-9);
  EXPECT_NEAR(corner->y, -75, 1e-9);
  EXPECT_NEAR(nominal_gsd_m(level_camera(), kFrame), 200.0 / 640, 1e-12);
}

// Oracle: angles of the ray in the plane of the tilt.
TEST(GroundOf, PitchLooksForwardAndRollLooksLeft) {
  FrameCamera camera = level_camera();
  camera.pitch = Angle::degrees(20);
  EXPECT_NEAR(ground_at(camera, {320, 240})->y, -100 * std::tan(20 * M_PI / 180), 1e-9);
  EXPECT_NEAR(ground_at(camera, {320, 0})->y, -100 * std::tan(20 * M_PI / 180 + std::atan(0.75)), 1e-9);
  camera = level_camera();
  camera.roll = Angle::degrees(10);
  EXPECT_NEAR(ground_at(camera, {320, 240})->x, -100 * std::tan(10 * M_PI / 180), 1e-9);
  EXPECT_NEAR(ground_at(camera, {640, 240})->x, 100 * std::tan((45 - 10) * M_PI / 180), 1e-9);
}

// Oracle: how far the ground on the optical axis moves when the camera turns by a hundredth of the angle, and when it
// is a hundredth of the error higher.
TEST(NadirSigma, IsWhatSmallErrorsOfAttitudeAndHeightMoveTheGroundInViewBy) {
  const cv::Point2d middle(320, 240);
  for (const double pitch_deg : {0.0, 30.0, -45.0}) {
    FrameCamera camera = level_camera();
    camera.pitch = Angle::degrees(pitch_deg);
    const auto moved_m = [&](const FrameCamera& other) {
      return 100.0 * std::abs(ground_at(other, middle)->y - ground_at(camera, middle)->y);
    };
    FrameCamera turned = camera;
    turned.pitch = Angle::degrees(pitch_deg + 0.01);
    FrameCamera higher = camera;
    higher.agl_m *= 1.0 + 0.01 * kHeightSigma;
    const double told_m = std::hypot(moved_m(turned), moved_m(higher));
    const double untold_m = std::hypot(5.0 * moved_m(turned), moved_m(higher));
    const double told_to_two_m = std::hypot(2.0 * moved_m(turned), moved_m(higher));
    camera.roll = Angle();
    EXPECT_NEAR(nadir_sigma_m(camera), told_m, 0.002 * told_m) << pitch_deg;
    camera.roll.reset();
    EXPECT_NEAR(nadir_sigma_m(camera), untold_m, 0.002 * untold_m) << pitch_deg;
    camera.attitude_sigma = Angle::degrees(2.0);
    EXPECT_NEAR(nadir_sigma_m(camera), told_to_two_m, 0.002 * told_to_two_m) << pitch_deg;
    camera.roll = Angle();
    EXPECT_NEAR(nadir_sigma_m(camera), told_to_two_m, 0.002 * told_to_two_m) << pitch_deg;
  }
}

TEST(NadirSigma, IsThatOfARollAsOfAPitchAndFiniteAtTheHorizon) {
  FrameCamera rolled = level_camera();
  FrameCamera pitched = level_camera();
  rolled.roll = pitched.pitch = Angle::degrees(60.0);
  EXPECT_NEAR(nadir_sigma_m(rolled), nadir_sigma_m(pitched), 1e-9);
  rolled.roll = Angle::degrees(90.0);
  EXPECT_TRUE(std::isfinite(nadir_sigma_m(rolled)));
}

/// A frame of a narrower lens, 300 m above a few straight roads that lie anyhow.
class DrawnRoads {
 public:
  explicit DrawnRoads(unsigned seed) : random_(seed) {}

  /// By how much the roads in a frame of `camera` have to be turned that were taken for those of one that is `told`, to
  /// lie where they do in the sense of least squares across them.
  double turn(const FrameCamera& camera, const FrameCamera& told) {
    constexpr int kRoads = 5;
    cv::Matx33d normal = cv::Matx33d::zeros();
    cv::Vec3d right;
    const cv::Matx33d camera_from_level = level_from_camera(camera).t();
    const Lens lens = lens_of(camera, kFrame);
    const cv::Point2d middle = *ground_at(camera, {320, 240});
    for (int road = 0; road < kRoads; ++road) {
      const cv::Point2d through = *ground_at(camera, {uniform(0, 640), uniform(0, 480)});
      const double angle = uniform(0, M_PI);
      const cv::Point2d along(std::cos(angle), std::sin(angle));
      const cv::Point2d across(-along.y, along.x);
      const bool ends_there = uniform(0, 3) < 1.0;
      for (double at_m = ends_there ? 0.0 : -800.0; at_m < 800.0; at_m += 4.0) {
        const cv::Point2d ground = through + at_m * along;
        const cv::Vec3d seen = camera_from_level * cv::Vec3d(ground.x, ground.y, camera.agl_m);
        if (seen[2] <= 0.0) continue;
        const cv::Point2d ray(seen[0] / seen[2], seen[1] / seen[2]);
        if (!cv::Rect2d({0, 0}, kFrame).contains(lens.pixels_of({ray})[0])) continue;
        const cv::Point2d taken_for = *ground_of(told, ray);
        const cv::Point2d arm = taken_for - middle;
        const cv::Vec3d row(across.x, across.y, across.dot(cv::Point2d(-arm.y, arm.x)));
        normal += row * row.t();
        right += row * across.dot(ground - taken_for);
      }
    }
    return normal.solve(right, cv::DECOMP_SVD)[2];
  }

  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  double normal(double sigma) { return std::normal_distribution(0.0, sigma)(random_); }

 private:
  std::mt19937 random_;
};

/// Root of the mean square over cameras that lean by `lean` anywhere, of which roll and pitch are told with such
/// errors, and the height with one as large as assumed.
double drawn_turn_rad(Angle lean, Angle attitude_sigma) {
  constexpr int kDraws = 500;
  const double sigma = attitude_sigma.radians();
  DrawnRoads roads(7);
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double to = roads.uniform(0, 2 * M_PI);
    FrameCamera told;
    told.focal_px = 560.0;
    told.agl_m = 300.0;
    told.roll = std::sin(to) * lean;
    told.pitch = std::cos(to) * lean;
    FrameCamera camera = told;
    camera.roll = *told.roll + Angle::radians(roads.normal(sigma));
    camera.pitch = *told.pitch + Angle::radians(roads.normal(sigma));
    camera.agl_m *= 1.0 + roads.normal(kHeightSigma);
    squares += std::pow(roads.turn(camera, told), 2.0);
  }
  return std::sqrt(squares / kDraws);
}

TEST(NadirHeadingSigma, IsHowFarErrorsOfAttitudeAndHeightTurnRoadsDrawnAtRandom) {
  for (const double lean_deg : {0.0, 15.0, 25.0, 40.0}) {
    FrameCamera camera = level_camera();
    camera.roll = Angle();
    camera.pitch = Angle::degrees(lean_deg);
    const double drawn_rad = drawn_turn_rad(*camera.pitch, kToldAttitudeSigma);
    EXPECT_NEAR(nadir_heading_sigma(camera).radians(), drawn_rad, 0.25 * drawn_rad) << lean_deg;
    camera.attitude_sigma = Angle::degrees(3.0);
    const double drawn_of_three_rad = drawn_turn_rad(*camera.pitch, *camera.attitude_sigma);
    EXPECT_NEAR(nadir_heading_sigma(camera).radians(), drawn_of_three_rad, 0.25 * drawn_of_three_rad) << lean_deg;
  }
  const double drawn_rad = drawn_turn_rad(Angle(), kUntoldAttitudeSigma);
  EXPECT_NEAR(nadir_heading_sigma(level_camera()).radians(), drawn_rad, 0.25 * drawn_rad) << "nobody told the attitude";
}

TEST(NadirHeadingSigma, IsThatOfARollAsOfAPitchAndFiniteAtTheHorizon) {
  FrameCamera rolled = level_camera();
  FrameCamera pitched = level_camera();
  rolled.roll = pitched.pitch = Angle::degrees(60.0);
  EXPECT_NEAR(nadir_heading_sigma(rolled).radians(), nadir_heading_sigma(pitched).radians(), 1e-9);
  rolled.roll = Angle::degrees(90.0);
  EXPECT_TRUE(std::isfinite(nadir_heading_sigma(rolled).radians()));
}

TEST(GroundOf, NothingLiesAboveTheHorizon) {
  FrameCamera camera = level_camera();
  camera.pitch = Angle::degrees(80);
  EXPECT_FALSE(ground_at(camera, {320, 0}));
  EXPECT_TRUE(ground_at(camera, {320, 479}));
}

FrameCamera calibrated() {
  FrameCamera camera;
  camera.focal_px = 500.0;
  camera.agl_m = 100;
  return camera;
}

TEST(LensOf, TakesThePrincipalPointFromTheCentreOfTheFirstPixel) {
  FrameCamera camera = calibrated();
  EXPECT_EQ(*lens_of(camera, kFrame).ray_of({320, 240}), cv::Point2d());
  camera.principal_px = {300.0, 250.0};
  EXPECT_EQ(*lens_of(camera, kFrame).ray_of({300.5, 250.5}), cv::Point2d());
}

TEST(FrameCamera, IsRefusedWithACalibrationOfFramesOfAnotherSize) {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  FrameCamera camera = calibrated();
  for (const cv::Point2d far : {cv::Point2d(630, 470), {150, 240}, {320, 361}, {kNoNumber, 240}}) {
    camera.principal_px = far;
    EXPECT_THAT(testing::message_of([&] { validate(camera, kFrame); }), ::testing::HasSubstr("for frames of this size"))
        << far;
  }
  camera.principal_px = {200.0, 350.0};
  EXPECT_NO_THROW(validate(camera, kFrame));
}

TEST(FrameCamera, IsRefusedWhereItsAttitudeIsKnownToNothingOrToMoreThanAnybodyTells) {
  FrameCamera camera = level_camera();
  for (const double sigma_deg : {0.0, -1.0, 20.1, std::numeric_limits<double>::quiet_NaN()}) {
    camera.attitude_sigma = Angle::degrees(sigma_deg);
    EXPECT_THAT(testing::message_of([&] { validate(camera, kFrame); }), ::testing::HasSubstr("attitude_sigma_deg"))
        << sigma_deg;
  }
  for (const double sigma_deg : {0.01, 20.0}) {
    camera.attitude_sigma = Angle::degrees(sigma_deg);
    EXPECT_NO_THROW(validate(camera, kFrame)) << sigma_deg;
  }
}

TEST(FrameCamera, NeedsTheFocalLengthOfACalibration) {
  FrameCamera camera = level_camera();
  EXPECT_NO_THROW(validate(camera, kFrame));
  camera.principal_px = {320.0, 240.0};
  EXPECT_THAT(testing::message_of([&] { validate(camera, kFrame); }), ::testing::HasSubstr("not the field of view"));
  camera = level_camera();
  camera.lens = LensModel::kFisheye;
  EXPECT_EQ(testing::code_of([&] { validate(camera, kFrame); }), "frame-camera");
}

}  // namespace
}  // namespace roadfix
