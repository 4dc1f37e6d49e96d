#include "server/api/altitude_request.hpp"

#include <gtest/gtest.h>

#include <variant>

#include "core/units/error.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/frame_scale.hpp"
#include "tests/server/api/request_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/drone_jpeg.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

Content frame(const json& told) {
  json request{{"kind", "frame"}};
  request.update(told);
  return {fields_of(request, joined({feature_fields(), altitude_fields(), {"alt_m"}}))};
}
/// With a picture whose file tells its camera, and of its height what `height` says.
Content photo(const std::string& height, const json& told) {
  Content content = frame(told);
  content.fields.add({{"exif", true}}, feature_fields());
  give_picture(content, testing::drone_jpeg(cv::Mat(9, 12, CV_8UC1, cv::Scalar(128)),
                                            height + "drone-dji:CalibratedFocalLength=\"100\" "
                                                     "drone-dji:GimbalYawDegree=\"0\" "
                                                     "drone-dji:GimbalPitchDegree=\"-90\" "
                                                     "drone-dji:GimbalRollDegree=\"0\""));
  return content;
}
constexpr const char* kHigher = "drone-dji:RelativeAltitude=\"+40.00\" ";
double ground_at_700_m(double above_sea_m) { return above_sea_m - 700.0; }

TEST(AltitudeRequest, IsTheHeightAboveGroundWhereThatIsTold) {
  Content content = frame({{"agl_m", 120}, {"alt_m", 1000}, {"fov_deg", 60}});
  const auto altitude = take_altitude(content, ground_at_700_m);
  ASSERT_TRUE(altitude);
  EXPECT_FALSE(altitude->above_sea_m);
  EXPECT_EQ(altitude->agl_m, 120.0);
}

TEST(AltitudeRequest, IsThatAboveTheSeaOtherwiseAndTheOneAboveGroundFollows) {
  Content content = frame({{"alt_m", 1000}, {"fov_deg", 60}});
  const auto altitude = take_altitude(content, ground_at_700_m);
  ASSERT_TRUE(altitude);
  EXPECT_EQ(altitude->above_sea_m, 1000.0);
  EXPECT_EQ(altitude->agl_m, 300.0);
  EXPECT_EQ(told_agl_m(content.fields), 300.0) << "which makes its size";
}

TEST(AltitudeRequest, IsNoneWhereTheSizeIsToldOtherwise) {
  for (const json& told : {json{{"gsd_m", 0.5}, {"alt_m", 1000}}, json{{"exif", true}},
                           json{{"kind", "feature_map"}, {"alt_m", 1000}}, json{{"fov_deg", 60}}}) {
    Content content = frame(told);
    EXPECT_FALSE(take_altitude(content, ground_at_700_m)) << told;
  }
}

TEST(AltitudeRequest, IsRefusedBeyondAnyHeight) {
  Content content = frame({{"agl_m", -5}, {"fov_deg", 60}});
  EXPECT_EQ(refused([&] { take_altitude(content, ground_at_700_m); }), "parameter-out-of-range agl_m");
  Content higher = photo(kHigher, {{"takeoff_alt_m", 60'000}});
  EXPECT_EQ(refused([&] { take_altitude(higher, ground_at_700_m); }), "parameter-out-of-range takeoff_alt_m");
}

TEST(AltitudeRequest, OfAPhotoIsThatOfItsTakeOffAndWhatItsFileTellsAboveThat) {
  Content content = photo(kHigher, {{"takeoff_alt_m", 800}, {"alt_m", 5000}});
  const auto altitude = take_altitude(content, ground_at_700_m);
  ASSERT_TRUE(altitude);
  EXPECT_EQ(altitude->above_sea_m, 840.0);
  EXPECT_EQ(altitude->agl_m, 140.0);
  const FrameScale scale = parse_frame_scale(content.fields, content.image);
  EXPECT_EQ(std::get<FrameCamera>(scale.view).agl_m, 140.0) << "which makes its size";
  const Content lower = photo("drone-dji:RelativeAltitude=\"-15.00\" ", json::object());
  EXPECT_EQ(std::get<FrameCamera>(parse_frame_scale(content.fields, lower.image).view).agl_m, 85.0)
      << "of another photo of that flight";
}

TEST(AltitudeRequest, OfAPhotoIsThatAboveTheSeaWhereTheMapKnowsItsGround) {
  Content content = photo(kHigher, {{"alt_m", 1000}});
  const auto altitude = take_altitude(content, ground_at_700_m);
  ASSERT_TRUE(altitude);
  EXPECT_EQ(altitude->above_sea_m, 1000.0);
  EXPECT_EQ(std::get<FrameCamera>(parse_frame_scale(content.fields, content.image).view).agl_m, 300.0);
  Content told = photo(kHigher, {{"alt_m", 1000}, {"agl_m", 120}});
  EXPECT_EQ(take_altitude(told, ground_at_700_m).value().agl_m, 120.0) << "what is told of the ground counts";
}

TEST(AltitudeRequest, OfAPhotoIsLeftToItsFileWhereTheMapKnowsNoHeights) {
  Content content = photo(kHigher, {{"alt_m", 1000}});
  const auto refused_for = [](const char* code) {
    return [code](double) -> double { throw InvalidInput(code, "as the map does"); };
  };
  EXPECT_FALSE(take_altitude(content, refused_for("terrain-missing")));
  EXPECT_EQ(std::get<FrameCamera>(parse_frame_scale(content.fields, content.image).view).agl_m, 40.0);
  EXPECT_EQ(testing::code_of([&] { take_altitude(content, refused_for("below-ground")); }), "below-ground");
}

TEST(AltitudeRequest, OfATakeOffGoesWithPhotosThatTellHowMuchHigherTheyAre) {
  const auto refusal = [](Content content) { return refused([&] { take_altitude(content, ground_at_700_m); }); };
  const json takeoff{{"takeoff_alt_m", 800}};
  const auto with = [&](const json& told) {
    json both = takeoff;
    both.update(told);
    return both;
  };
  EXPECT_EQ(refusal(frame(with({{"fov_deg", 60}}))), "bad-parameter takeoff_alt_m");
  EXPECT_EQ(refusal(frame(with({{"kind", "feature_map"}}))), "bad-parameter takeoff_alt_m");
  EXPECT_EQ(refusal(photo(kHigher, with({{"agl_m", 40}}))), "bad-parameter takeoff_alt_m");
  Content unknown = photo("", takeoff);
  EXPECT_EQ(testing::code_of([&] { take_altitude(unknown, ground_at_700_m); }), "camera-not-in-file");
}

TEST(AltitudeRequest, OfAPhotoIsOtherwiseThatOfTheCameraInItsFile) {
  Features features;
  EXPECT_FALSE(altitude_in_file(features));
  features.camera_in_file.emplace().agl_m = 40.0;
  const auto altitude = altitude_in_file(features);
  ASSERT_TRUE(altitude);
  EXPECT_FALSE(altitude->above_sea_m);
  EXPECT_EQ(altitude->agl_m, 40.0);
}

}  // namespace
}  // namespace roadfix::api
