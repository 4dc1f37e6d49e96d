#include "server/api/altitude_request.hpp"

#include <gtest/gtest.h>

#include "server/api/feature_request.hpp"
#include "server/api/frame_scale.hpp"
#include "tests/server/api/request_fixture.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

Fields frame(const json& told) {
  json request{{"kind", "frame"}};
  request.update(told);
  return fields_of(request, joined({feature_fields(), {"alt_m"}}));
}
double ground_at_700_m(double above_sea_m) { return above_sea_m - 700.0; }

TEST(AltitudeRequest, IsTheHeightAboveGroundWhereThatIsTold) {
  Fields fields = frame({{"agl_m", 120}, {"alt_m", 1000}, {"fov_deg", 60}});
  const auto altitude = take_altitude(fields, ground_at_700_m);
  ASSERT_TRUE(altitude);
  EXPECT_FALSE(altitude->above_sea_m);
  EXPECT_EQ(altitude->agl_m, 120.0);
}

TEST(AltitudeRequest, IsThatAboveTheSeaOtherwiseAndTheOneAboveGroundFollows) {
  Fields fields = frame({{"alt_m", 1000}, {"fov_deg", 60}});
  const auto altitude = take_altitude(fields, ground_at_700_m);
  ASSERT_TRUE(altitude);
  EXPECT_EQ(altitude->above_sea_m, 1000.0);
  EXPECT_EQ(altitude->agl_m, 300.0);
  EXPECT_EQ(told_agl_m(fields), 300.0) << "which makes its size";
}

TEST(AltitudeRequest, IsNoneWhereTheSizeIsToldOtherwise) {
  for (const json& told : {json{{"gsd_m", 0.5}, {"alt_m", 1000}}, json{{"exif", true}, {"alt_m", 1000}},
                           json{{"kind", "feature_map"}, {"alt_m", 1000}}, json{{"fov_deg", 60}}}) {
    Fields fields = frame(told);
    EXPECT_FALSE(take_altitude(fields, ground_at_700_m)) << told;
  }
}

TEST(AltitudeRequest, IsRefusedBeyondAnyHeight) {
  Fields fields = frame({{"agl_m", -5}, {"fov_deg", 60}});
  EXPECT_EQ(refused([&] { take_altitude(fields, ground_at_700_m); }), "parameter-out-of-range agl_m");
}

}  // namespace
}  // namespace roadfix::api
