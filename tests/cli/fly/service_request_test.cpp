#include "cli/fly/service_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace roadfix::fly {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Report seen_by(const FrameCamera& camera) {
  Report report;
  report.sequence = 3;
  report.time_us = 4'000'000;
  report.odometry = Odometry{20.0, -0.5, Angle::degrees(3.0)};
  report.frame = [camera] { return CameraFrame{{cv::Mat(20, 30, CV_8UC3, cv::Scalar(7, 7, 7)), {}}, camera, 2.0}; };
  return report;
}

FrameCamera camera() {
  FrameCamera camera;
  camera.agl_m = 250.0;
  camera.focal_px = 40.0;
  return camera;
}

TEST(TrackRequest, HasTheAreaAsThePriorWhereThereIsOne) {
  EXPECT_FALSE(track_request({}, 1, {}).contains("bbox"));
  Prior start;
  start.box = GeoBox{{-17.0, 179.5}, {-16.5, 180.5}};
  EXPECT_EQ(track_request({}, 1, start).at("bbox"), (nlohmann::json{179.5, -17.0, 180.5, -16.5}));
}

TEST(TrackRequest, TellsWhatIsKnownOfTheStart) {
  ServicePlan plan;
  Prior start;
  start.circle = GeoCircle{{37.76, 38.27}, 50.0};
  start.heading = HeadingRange{Angle::degrees(-90.0), Angle::degrees(15.0)};
  EXPECT_FALSE(track_request(plan, 1, start).contains("known_start"));
  plan.filter.start_is_known = true;
  const nlohmann::json request = track_request(plan, 1, start);
  EXPECT_EQ(request.at("lat"), 37.76);
  EXPECT_EQ(request.at("lon"), 38.27);
  EXPECT_EQ(request.at("radius_m"), 50.0);
  EXPECT_NEAR(request.at("heading_deg"), -90.0, 1e-9);
  EXPECT_NEAR(request.at("heading_range_deg"), 15.0, 1e-9);
  EXPECT_EQ(request.at("known_start"), true);
}

TEST(StepRequest, OfAFrameTellsWhatWasToldOfItsAttitudeAndNoMore) {
  FrameCamera told = camera();
  told.pitch = Angle();  // straight down is something to tell
  const StepRequest request = step_request(seen_by(told));
  EXPECT_THAT(request.query, HasSubstr("pitch_deg=0.0"));
  EXPECT_THAT(request.query, Not(HasSubstr("roll_deg")));
  told.roll = Angle::degrees(-4.0);
  told.pitch.reset();
  EXPECT_THAT(step_request(seen_by(told)).query, HasSubstr("roll_deg=-4.0"));
  EXPECT_THAT(step_request(seen_by(told)).query, Not(HasSubstr("pitch_deg")));
  told.attitude_sigma = Angle::degrees(0.5);
  EXPECT_THAT(step_request(seen_by(told)).query, HasSubstr("attitude_sigma_deg=0.5"));
}

TEST(StepRequest, IsAPictureDescribedInTheQuery) {
  const StepRequest request = step_request(seen_by(camera()));
  EXPECT_STREQ(request.content_type, "image/png");
  EXPECT_EQ(request.body.substr(1, 3), "PNG");
  EXPECT_EQ(request.query,
            "?agl_m=250.0&cell_m=2.0&focal_px=40.0&forward_m=20.0&kind=frame&right_m=-0.5&sequence=3"
            "&time_us=4000000&turn_deg=3.0");
}

TEST(StepRequest, OfAFrameTellsTheHeightAboveTheSeaWhereThatIsKnownInPlaceOfTheOneThatFollows) {
  Report report = seen_by(camera());
  report.altitude = Altitude{std::nullopt, 250.0};
  EXPECT_THAT(step_request(report).query, HasSubstr("agl_m=250.0"));
  report.altitude->above_sea_m = 930.5;
  EXPECT_THAT(step_request(report).query, HasSubstr("alt_m=930.5"));
  EXPECT_THAT(step_request(report).query, Not(HasSubstr("agl_m")));
}

TEST(StepRequest, IsJsonWhereNothingWasSeen) {
  Report report;
  report.sequence = 3;
  report.time_us = 4'000'000;
  const StepRequest request = step_request(report);
  EXPECT_STREQ(request.content_type, "application/json");
  EXPECT_EQ(request.query, "");
  EXPECT_EQ(nlohmann::json::parse(request.body), (nlohmann::json{{"sequence", 3}, {"time_us", 4'000'000}}));
}

}  // namespace
}  // namespace roadfix::fly
