#include "server/api/fix_request.hpp"

#include <gmock/gmock.h>

#include "tests/server/api/request_fixture.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

Prior prior_of(const json& request) { return parse_prior(fields_of(request, prior_fields())); }
std::string refused_prior(const json& request) {
  return refused([&] { prior_of(request); });
}

TEST(PriorRequest, LeavesTheWholeMapWhereNothingIsTold) {
  const Prior prior = parse_prior(Fields());
  EXPECT_FALSE(prior.circle || prior.box || prior.heading);
}

TEST(PriorRequest, TellsACircleByItsCentreAndItsRadius) {
  const GeoCircle circle = prior_of({{"lat", 57.7}, {"lon", -11.9}, {"radius_m", 300}}).circle.value();
  EXPECT_EQ(circle.centre.lat_deg, 57.7);
  EXPECT_EQ(circle.centre.lon_deg, -11.9);
  EXPECT_EQ(circle.radius_m, 300.0);
  EXPECT_EQ(refused_prior({{"lat", 91}, {"lon", 11.9}, {"radius_m", 300}}), "parameter-out-of-range lat");
  EXPECT_EQ(refused_prior({{"lat", 57.7}, {"lon", 181}, {"radius_m", 300}}), "parameter-out-of-range lon");
  EXPECT_EQ(refused_prior({{"lat", 57.7}, {"lon", 11.9}, {"radius_m", 0}}), "parameter-out-of-range radius_m");
}

TEST(PriorRequest, NamesWhatIsMissingOfWhatGoesTogether) {
  const json circle{{"lat", 57.7}, {"lon", 11.9}, {"radius_m", 300}};
  const json heading{{"heading_deg", 90}, {"heading_range_deg", 10}};
  for (const json& whole : {circle, heading}) {
    for (const auto& [name, value] : whole.items()) {
      json without = whole;
      without.erase(name);
      EXPECT_EQ(refused_prior(without), "missing-parameter " + name);
    }
  }
  EXPECT_THAT(testing::message_of([] {
                prior_of({{"lat", 57.7}});
              }),
              ::testing::HasSubstr("give lat, lon, radius_m together"));
}

TEST(PriorRequest, TellsABoxFromWestToNorth) {
  const GeoBox box = prior_of({{"bbox", {11.0, 57.0, 12.0, 58.0}}}).box.value();
  EXPECT_EQ(box.south_west.lon_deg, 11.0);
  EXPECT_EQ(box.south_west.lat_deg, 57.0);
  EXPECT_EQ(box.north_east.lon_deg, 12.0);
  EXPECT_EQ(box.north_east.lat_deg, 58.0);
}

TEST(PriorRequest, TellsABoxAcrossTheAntimeridianEitherWay) {
  for (const char* sides : {"179.9,-17.1,180.2,-16.8", "179.9,-17.1,-179.8,-16.8"}) {
    const GeoBox box = parse_prior(Fields(http::Parameters{{"bbox", sides}})).box.value();
    EXPECT_EQ(box.south_west.lon_deg, 179.9) << sides;
    EXPECT_DOUBLE_EQ(box.north_east.lon_deg, 180.2) << sides;
  }
}

TEST(PriorRequest, TellsABoxByLongitudesUpTo360Too) {
  const GeoBox box = prior_of({{"bbox", {350, 45, 10, 46}}}).box.value();
  EXPECT_EQ(box.south_west.lon_deg, 350.0);
  EXPECT_EQ(box.north_east.lon_deg, 370.0);
}

TEST(PriorRequest, RefusesABoxThatHoldsNothingOrIsNotOnEarth) {
  for (const json& box : {json{12, 57, 11, 58}, json{11, 58, 12, 57}, json{11, 57, 11, 58}, json{11, 57, 12, 57},
                          json{11, -91, 12, 58}, json{11, 57, 12, 91}, json{-361, 57, 12, 58}, json{11, 57, 361, 58},
                          json{11, 57, 12}, json{11, 57, 12, 58, 1}, json("11,57,12,58")}) {
    EXPECT_EQ(refused_prior({{"bbox", box}}), "bad-parameter bbox") << box;
  }
}

TEST(PriorRequest, TellsAHeadingByHalfTheWidthOfItsRange) {
  const HeadingRange heading = prior_of({{"heading_deg", -90}, {"heading_range_deg", 20}}).heading.value();
  EXPECT_NEAR(heading.centre.degrees(), -90.0, 1e-9);
  EXPECT_NEAR(heading.half_width.degrees(), 20.0, 1e-9);
  EXPECT_EQ(refused_prior({{"heading_deg", 90}, {"heading_range_deg", 181}}),
            "parameter-out-of-range heading_range_deg");
}

FixOptions options_of(const json& request, const Limits& limits = {}) {
  return parse_fix_options(fields_of(request, fix_option_fields()), limits);
}

TEST(FixOptionsRequest, SearchesWithoutProofOrLimitUnlessItIsAskedTo) {
  Limits limits;
  limits.search_km2 = 12.5;
  const FixOptions options = options_of(json::object(), limits);
  EXPECT_EQ(options.confidence, 0.99);
  EXPECT_EQ(options.search.max_modes, 8);
  EXPECT_EQ(options.search.scale_range, 0.0);
  EXPECT_FALSE(options.search.proof_time);
  EXPECT_FALSE(parse_time_limit(fields_of(json::object(), fix_option_fields())));
  EXPECT_EQ(options.max_search_km2, 12.5) << "which is the operator's to say";
}

TEST(FixOptionsRequest, TakesWhatItIsToldWithinTheLimits) {
  Limits limits;
  limits.modes = 16;
  const FixOptions options = options_of({{"confidence", 0.9}, {"max_modes", 16}, {"scale_range", 0.15}}, limits);
  EXPECT_EQ(options.confidence, 0.9);
  EXPECT_EQ(options.search.max_modes, 16);
  EXPECT_EQ(options.search.scale_range, 0.15);
  EXPECT_EQ(refused([&] { options_of({{"max_modes", 17}}, limits); }), "parameter-out-of-range max_modes");
  EXPECT_EQ(refused([&] { options_of({{"max_modes", 2.5}}, limits); }), "bad-parameter max_modes");
  EXPECT_EQ(refused([&] { options_of({{"confidence", 1}}, limits); }), "parameter-out-of-range confidence");
}

TEST(FixOptionsRequest, RoundsTimesUpSoThatALittleIsNotNone) {
  const auto proof = [](double seconds) { return options_of({{"proof_s", seconds}}).search.proof_time; };
  EXPECT_FALSE(proof(0.0));
  EXPECT_EQ(proof(1e-6), milliseconds(1));
  EXPECT_EQ(proof(1.5), milliseconds(1500));
  const auto limit = [](double seconds) {
    return parse_time_limit(fields_of({{"time_limit_s", seconds}}, fix_option_fields()));
  };
  EXPECT_EQ(limit(1e-6), milliseconds(1));
  EXPECT_EQ(limit(2.0), milliseconds(2000));
  EXPECT_EQ(refused([&] { limit(0.0); }), "parameter-out-of-range time_limit_s");
}

std::vector<GeoPose> poses_of(const json& poses, const Limits& limits = {}) {
  return parse_poses(fields_of({{"poses", poses}}, {"poses"}), limits);
}
std::string refused_poses(const json& poses) {
  return refused([&] { poses_of(poses); });
}

const json kPose{{"lat", 57.7}, {"lon", 11.9}, {"heading_deg", 350}};

TEST(PosesRequest, KeepsTheirOrder) {
  const auto poses = poses_of({kPose, {{"lat", -1}, {"lon", -2}, {"heading_deg", -3}}});
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].position.lat_deg, 57.7);
  EXPECT_EQ(poses[0].position.lon_deg, 11.9);
  EXPECT_NEAR(poses[0].heading.degrees(), 350.0, 1e-9);
  EXPECT_EQ(poses[1].position.lat_deg, -1.0);
}

TEST(PosesRequest, SaysWhichPoseCannotBeOneAndWhy) {
  const auto second = [](const char* name, const json& value) {
    json pose = kPose;
    if (value.is_null()) {
      pose.erase(name);
    } else {
      pose[name] = value;
    }
    return refused_poses({kPose, pose});
  };
  EXPECT_EQ(second("lat", 90.5), "parameter-out-of-range poses[1].lat");
  EXPECT_EQ(second("lon", "11.9"), "bad-parameter poses[1].lon");
  EXPECT_EQ(second("heading_deg", {}), "missing-parameter poses[1].heading_deg");
  EXPECT_EQ(second("alt_m", 100), "bad-parameter poses[1]") << "nobody would look at it";
  EXPECT_EQ(refused_poses({kPose, 7}), "bad-parameter poses[1]");
}

TEST(PosesRequest, NeedsAListOfAtLeastOneInJson) {
  EXPECT_EQ(refused([] { parse_poses(Fields(), {}); }), "missing-parameter poses");
  EXPECT_EQ(refused([] { parse_poses(Fields(http::Parameters{{"poses", "[]"}}), {}); }), "bad-parameter poses");
  EXPECT_EQ(refused_poses(json::array()), "bad-parameter poses");
  EXPECT_EQ(refused_poses(kPose), "bad-parameter poses");
}

TEST(PosesRequest, MayHoldAsManyAsTheLimitAllows) {
  Limits limits;
  limits.poses = 2;
  EXPECT_EQ(poses_of({kPose, kPose}, limits).size(), 2U);
  EXPECT_EQ(testing::code_of([&] { poses_of({kPose, kPose, kPose}, limits); }), "too-many-poses");
}

}  // namespace
}  // namespace roadfix::api
