#include "server/api/frame_scale.hpp"

#include <gmock/gmock.h>

#include <variant>

#include "tests/server/api/request_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/drone_jpeg.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

FrameScale scale_of(const json& request, const std::vector<std::uint8_t>& picture = {}) {
  return parse_frame_scale(fields_of(request, frame_scale_fields()), picture);
}
FrameCamera camera_of(const json& request) { return std::get<FrameCamera>(scale_of(request).view); }
std::string refused_scale(const json& request) {
  return refused([&] { scale_of(request); });
}

/// A camera 120 m above the ground, with what is added or changed.
json told(const json& change) {
  json request{{"fov_deg", 60}, {"agl_m", 120}};
  request.update(change);
  return request;
}

TEST(FrameScale, IsToldDirectlyOfAFrameSeenFromStraightAbove) {
  const FrameScale scale = scale_of({{"gsd_m", 0.5}, {"exif", false}});
  EXPECT_EQ(std::get<StraightDown>(scale.view).gsd_m, 0.5);
  EXPECT_FALSE(scale.in_file);
  for (const double mistaken : {0.0, 1e-4, 20.0}) {
    EXPECT_EQ(refused_scale({{"gsd_m", mistaken}}), "parameter-out-of-range gsd_m");
  }
}

TEST(FrameScale, IsNotToldTwice) {
  const json of_a_camera{{"fov_deg", 60},     {"focal_px", 900}, {"principal_px", {960, 540}},
                         {"lens", "fisheye"}, {"agl_m", 120},    {"distortion", {0.1, 0, 0, 0}},
                         {"roll_deg", 0},     {"pitch_deg", 0},  {"attitude_sigma_deg", 2},
                         {"exif", true}};
  EXPECT_EQ(of_a_camera.size() + 1, frame_scale_fields().size()) << "all but gsd_m";
  for (const auto& [name, value] : of_a_camera.items()) {
    EXPECT_EQ(refused_scale({{"gsd_m", 0.5}, {name, value}}), "bad-parameter " + name);
  }
  for (const char* of_the_lens : {"fov_deg", "focal_px", "principal_px", "lens", "distortion"}) {
    EXPECT_EQ(refused_scale({{"exif", true}, {of_the_lens, of_a_camera[of_the_lens]}}),
              std::string("bad-parameter ") + of_the_lens);
  }
}

TEST(FrameScale, NeedsAHeightAndEitherAFieldOfViewOrAFocalLength) {
  EXPECT_EQ(refused_scale(json::object()), "missing-parameter fov_deg");
  EXPECT_EQ(refused_scale({{"agl_m", 120}}), "missing-parameter fov_deg");
  EXPECT_EQ(refused_scale({{"fov_deg", 60}}), "missing-parameter agl_m");
  EXPECT_EQ(refused_scale(told({{"focal_px", 900}})), "bad-parameter focal_px") << "which of both would count?";
  const FrameCamera by_view = camera_of({{"fov_deg", 60}, {"agl_m", 120}});
  EXPECT_NEAR(by_view.horizontal_fov.value().degrees(), 60.0, 1e-12);
  EXPECT_FALSE(by_view.focal_px);
  EXPECT_EQ(by_view.agl_m, 120.0);
  const FrameCamera by_length = camera_of({{"focal_px", 900}, {"agl_m", 120}});
  EXPECT_EQ(by_length.focal_px, 900.0);
  EXPECT_FALSE(by_length.horizontal_fov);
}

TEST(FrameScale, TakesTheLensAsACalibrationGivesIt) {
  const FrameCamera plain = camera_of({{"fov_deg", 60}, {"agl_m", 120}});
  EXPECT_EQ(plain.lens, LensModel::kPerspective);
  EXPECT_FALSE(plain.principal_px);
  EXPECT_TRUE(plain.distortion.empty());
  const FrameCamera camera = camera_of({{"focal_px", 900},
                                        {"agl_m", 120},
                                        {"lens", "fisheye"},
                                        {"principal_px", {963.4, 541.2}},
                                        {"distortion", {-0.28, 0.07, 0.0004, -0.0002}}});
  EXPECT_EQ(camera.lens, LensModel::kFisheye);
  EXPECT_EQ(camera.principal_px, cv::Point2d(963.4, 541.2));
  EXPECT_THAT(camera.distortion, ElementsAre(-0.28, 0.07, 0.0004, -0.0002));
  EXPECT_EQ(refused_scale(told({{"lens", "wide"}})), "bad-parameter lens");
  EXPECT_EQ(refused_scale(told({{"principal_px", {963.4}}})), "bad-parameter principal_px");
  EXPECT_EQ(refused_scale(told({{"distortion", {0.1, 0, 0}}})), "bad-parameter distortion");
}

TEST(FrameScale, TellsAnAttitudeOfZeroFromOneThatNobodyTold) {
  const auto nadir_sigma_of = [](const json& attitude) { return nadir_sigma_m(camera_of(told(attitude))); };
  const double degree_m = 120.0 * Angle::degrees(1.0).radians();
  EXPECT_NEAR(nadir_sigma_of({{"roll_deg", 0}, {"pitch_deg", 0}}), degree_m, 1e-9);
  EXPECT_NEAR(nadir_sigma_of({{"roll_deg", 0}}), 5.0 * degree_m, 1e-9);
  EXPECT_NEAR(nadir_sigma_of({{"pitch_deg", 0}}), 5.0 * degree_m, 1e-9);
  EXPECT_NEAR(nadir_sigma_of(json::object()), 5.0 * degree_m, 1e-9);
  EXPECT_NEAR(nadir_sigma_of({{"attitude_sigma_deg", 2}}), 2.0 * degree_m, 1e-9) << "how far it may lean";
  EXPECT_NEAR(nadir_sigma_of({{"roll_deg", 0}, {"pitch_deg", 0}, {"attitude_sigma_deg", 0.2}}), 0.2 * degree_m, 1e-9);
  const json leaning = to_json(camera_of(told({{"roll_deg", -3}, {"pitch_deg", 20}})));
  EXPECT_NEAR(leaning["roll_deg"].get<double>(), -3.0, 1e-12);
  EXPECT_NEAR(leaning["pitch_deg"].get<double>(), 20.0, 1e-12);
}

TEST(FrameScale, TakesNumbersUpToTheEndsOfTheirRanges) {
  for (const auto& [name, least, most] : {std::tuple{"roll_deg", -90.0, 90.0}, {"pitch_deg", -90.0, 90.0}}) {
    EXPECT_EQ(refused_scale(told({{name, least}})), "nothing") << name;
    EXPECT_EQ(refused_scale(told({{name, least - 0.01}})), std::string("parameter-out-of-range ") + name);
    EXPECT_EQ(refused_scale(told({{name, most}})), "nothing") << name;
    EXPECT_EQ(refused_scale(told({{name, most + 0.01}})), std::string("parameter-out-of-range ") + name);
  }
  for (const auto& [name, most] : {std::pair{"agl_m", 20'000.0}, {"fov_deg", 179.0}, {"attitude_sigma_deg", 20.0}}) {
    EXPECT_EQ(refused_scale(told({{name, 0}})), std::string("parameter-out-of-range ") + name);
    EXPECT_EQ(refused_scale(told({{name, most}})), "nothing") << name;
    EXPECT_EQ(refused_scale(told({{name, most + 0.01}})), std::string("parameter-out-of-range ") + name);
  }
}

TEST(FrameScale, OfAPhotoIsReadBackFromWhatIsToldOfIt) {
  const auto photo = testing::drone_jpeg(
      cv::Mat(20, 30, CV_8UC1, cv::Scalar(128)),
      "drone-dji:RelativeAltitude=\"+40.00\" drone-dji:GimbalYawDegree=\"12\" drone-dji:GimbalPitchDegree=\"-80\" "
      "drone-dji:GimbalRollDegree=\"2\" drone-dji:DewarpFlag=\"0\" "
      "drone-dji:DewarpData=\"2021-05-11;30,30,1.5,-0.5,-0.112,0.015,0.0001,-0.0003,-0.028\"");
  EXPECT_FALSE(to_json(std::get<FrameCamera>(scale_of({{"exif", true}}, photo).view)).contains("attitude_sigma_deg"));
  const FrameScale scale = scale_of({{"exif", true}, {"attitude_sigma_deg", 0.5}}, photo);
  EXPECT_TRUE(scale.in_file);
  const FrameCamera& in_file = std::get<FrameCamera>(scale.view);
  ASSERT_TRUE(in_file.principal_px && in_file.distortion.size() == 5U);
  const json said = to_json(in_file);
  const FrameCamera again = camera_of(said);
  EXPECT_EQ(again.focal_px, in_file.focal_px);
  EXPECT_EQ(again.principal_px, in_file.principal_px);
  EXPECT_EQ(again.distortion, in_file.distortion);
  EXPECT_EQ(again.agl_m, in_file.agl_m);
  for (const char* name : {"roll_deg", "pitch_deg", "attitude_sigma_deg"}) {
    EXPECT_NEAR(to_json(again)[name].get<double>(), said[name].get<double>(), 1e-12) << name;
  }
}

TEST(FrameScale, OfAPhotoThatDoesNotTellWhereItLookedIsRefusedUntilTheRequestDoes) {
  const auto photo =
      testing::drone_jpeg(cv::Mat(20, 30, CV_8UC1, cv::Scalar(128)),
                          "drone-dji:RelativeAltitude=\"+40.00\" drone-dji:CalibratedFocalLength=\"30\"");
  const auto code = [&](const json& request) { return testing::code_of([&] { scale_of(request, photo); }); };
  EXPECT_EQ(code({{"exif", true}}), "camera-not-in-file");
  EXPECT_EQ(code({{"exif", true}, {"pitch_deg", 0}}), "camera-not-in-file");
  const json said =
      to_json(std::get<FrameCamera>(scale_of({{"exif", true}, {"roll_deg", 0}, {"pitch_deg", 10}}, photo).view));
  EXPECT_EQ(said["roll_deg"], 0.0);
  EXPECT_NEAR(said["pitch_deg"].get<double>(), 10.0, 1e-12);
}

TEST(FrameScale, SaysWhereAFileTellsNoCamera) {
  EXPECT_EQ(testing::code_of([] { scale_of({{"exif", true}}, {'n', 'o', 'n', 'e'}); }), "camera-not-in-file");
  EXPECT_EQ(refused_scale({{"exif", "yes"}}), "bad-parameter exif");
}

}  // namespace
}  // namespace roadfix::api
