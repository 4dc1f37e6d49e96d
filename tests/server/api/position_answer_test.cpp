#include "server/api/position_answer.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "server/autopilot/mavlink_frame.hpp"
#include "tests/server/api/request_fixture.hpp"
#include "tests/support/code_of.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::Pair;
using ::testing::StartsWith;

const json kKnown{{"status", "fix"},
                  {"pose", {{"lat", 37.7632}, {"lon", 38.2571}, {"heading_deg", 131.4}}},
                  {"sigma_m", {2.5, 1.5}},
                  {"heading_sigma_deg", 1.2}};
/// Where several places fit there is no pose at the top, whatever the places below it say.
const json kNotKnown{{"status", "ambiguous"}, {"modes", {{{"pose", kKnown["pose"]}}}}};
constexpr PositionTime kTime{1'763'724'896'250'000, std::chrono::milliseconds(250)};

PositionFormat format_of(const json& request, const std::string& accept = {}) {
  http::Request asked;
  if (!accept.empty()) asked.headers["accept"] = accept;
  return parse_position_format(asked, fields_of(request, position_fields()));
}
std::string refused_format(const json& request) {
  return refused([&] { format_of(request); });
}
json mavproxy(const json& answer, json request = {}, const PositionTime& time = kTime) {
  request["format"] = "mavproxy";
  return json::parse(position_response(answer, format_of(request), time).body);
}

TEST(PositionFormat, IsJsonUnlessTheFieldOrElseTheHeaderSaysOtherwise) {
  EXPECT_TRUE(format_of(json::object()).is_json());
  EXPECT_EQ(format_of(json::object(), "application/x-nmea-0183").encoding, PositionEncoding::kNmea);
  EXPECT_EQ(format_of({{"format", "gps_input"}}, "application/x-nmea-0183").type, "application/x-mavlink-gps-input");
  EXPECT_EQ(refused_format({{"format", "morse"}}), "bad-parameter format");
  EXPECT_EQ(testing::code_of([] { format_of(json::object(), "text/html"); }), "not-acceptable");
}

TEST(PositionFormat, TakesWhatTheClientKnowsOfItsVehicle) {
  const PositionFormat plain = format_of(json::object());
  EXPECT_FALSE(plain.altitude_msl_m);
  EXPECT_EQ(plain.camera_yaw.degrees(), 0.0);
  EXPECT_EQ(plain.satellites, 0);
  EXPECT_EQ(plain.sender.system, 1);
  EXPECT_EQ(plain.sender.component, autopilot::MavlinkSender().component);
  const PositionFormat told =
      format_of({{"alt_m", 512.5}, {"camera_yaw_deg", -90}, {"satellites", 10}, {"system", 7}, {"component", 42}});
  EXPECT_EQ(told.altitude_msl_m, 512.5);
  EXPECT_NEAR(told.camera_yaw.degrees(), -90.0, 1e-9);
  EXPECT_EQ(told.satellites, 10);
  EXPECT_EQ(told.sender.system, 7);
  EXPECT_EQ(told.sender.component, 42);
  for (const auto& [name, value] : {std::pair("alt_m", 50'001),
                                    {"satellites", 100},
                                    {"system", 0},
                                    {"system", 256},
                                    {"sensor", 0},
                                    {"sensor", 256},
                                    {"component", 0}}) {
    EXPECT_EQ(refused_format({{name, value}}), std::string("parameter-out-of-range ") + name);
  }
}

TEST(PositionAnswer, SaysWhereTheVehicleIsAndWhenItWasThere) {
  const json told = mavproxy(kKnown, {{"alt_m", 512.5}, {"satellites", 10}});
  EXPECT_EQ(told["lat"], 377'632'000);
  EXPECT_EQ(told["lon"], 382'571'000);
  EXPECT_EQ(told["alt"], 512.5);
  EXPECT_EQ(told["time_usec"], kTime.captured_us);
  EXPECT_EQ(told["satellites_visible"], 10);
  EXPECT_EQ(told["yaw"], 13'140);
}

TEST(PositionAnswer, SaysHowLongAgoThatWas) {
  constexpr std::size_t kProcessing = 10 + 8;  // header, and what precedes it in message 296
  const std::string packet = position_response(kKnown, format_of({{"format", "global_position_sensor"}}), kTime).body;
  std::uint32_t processing_us = 0;
  std::memcpy(&processing_us, packet.data() + kProcessing, sizeof(processing_us));
  EXPECT_EQ(processing_us, 250'000U);
}

TEST(PositionAnswer, IsAsAccurateAsTheLongerAxisOfItsEllipseWhicheverComesFirst) {
  for (const std::array<double, 2> sigma_m : {std::array{2.5, 1.5}, {1.5, 2.5}}) {
    json answer = kKnown;
    answer["sigma_m"] = sigma_m;
    EXPECT_EQ(mavproxy(answer)["horiz_accuracy"], 2.5) << sigma_m[0];
  }
}

TEST(PositionAnswer, TellsNoYawWhereTheHeadingIsHardlyKnown) {
  json answer = kKnown;
  answer["heading_sigma_deg"] = 10.5;
  EXPECT_EQ(mavproxy(answer)["yaw"], 0);
  EXPECT_EQ(mavproxy(answer)["lat"], 377'632'000);
  answer["heading_sigma_deg"] = 10.0;
  EXPECT_EQ(mavproxy(answer)["yaw"], 13'140);
}

TEST(PositionAnswer, TurnsTheHeadingOfTheFrameIntoThatOfTheVehicle) {
  EXPECT_EQ(mavproxy(kKnown, {{"camera_yaw_deg", 90}})["yaw"], 4'140);
  EXPECT_EQ(mavproxy(kKnown, {{"camera_yaw_deg", -270}})["yaw"], 4'140);
}

/// Of a MAVLink 2 packet; of other messages 0.
int message_of(const std::string& packet) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(packet.at(i)); };
  return byte(0) == 0xfd ? byte(7) | byte(8) << 8 | byte(9) << 16 : 0;
}

TEST(PositionAnswer, IsInTheFormatAskedForWithItsStatusBeside) {
  struct Case {
    const char* name;
    const char* type;
    int message;
    const char* begin;
  };
  for (const auto& [name, type, message, begin] :
       {Case{"global_position_sensor", "application/x-mavlink-global-position-sensor", 296, "\xfd"},
        {"command_int", "application/x-mavlink-command-int", 75, "\xfd"},
        {"gps_input", "application/x-mavlink-gps-input", 232, "\xfd"},
        {"mavproxy", "application/x-mavproxy-gps-input+json", 0, "{"},
        {"nmea", "application/x-nmea-0183", 0, "$GPGGA,"}}) {
    const http::Response response = position_response(kKnown, format_of({{"format", name}}), kTime);
    EXPECT_EQ(response.status, 200) << name;
    EXPECT_EQ(response.content_type, type);
    EXPECT_EQ(message_of(response.body), message) << name;
    EXPECT_THAT(response.body, StartsWith(begin)) << name;
    EXPECT_THAT(response.headers, Contains(Pair("Roadfix-Status", "fix"))) << name;
    EXPECT_THAT(response.headers, Contains(Pair("Vary", "Accept"))) << "caches must tell the formats apart";
  }
}

/// To PX4 an id of 0 is that of a slot which is off.
TEST(PositionAnswer, IsThatOfSensorOneUnlessTheClientNamesAnother) {
  constexpr std::size_t kId = 10 + 38;  // header, and what precedes it in message 296
  json request{{"format", "global_position_sensor"}};
  EXPECT_EQ(position_response(kKnown, format_of(request), kTime).body.at(kId), 1);
  request["sensor"] = 3;
  EXPECT_EQ(position_response(kKnown, format_of(request), kTime).body.at(kId), 3);
}

TEST(PositionAnswer, OfWhatIsNotKnownTellsNoPosition) {
  for (const char* name : {"global_position_sensor", "command_int"}) {
    const http::Response response = position_response(kNotKnown, format_of({{"format", name}}), kTime);
    EXPECT_EQ(response.status, 204) << name;
    EXPECT_EQ(response.body, "") << name;
    EXPECT_THAT(response.headers, Contains(Pair("Roadfix-Status", "ambiguous"))) << name;
  }
  EXPECT_EQ(mavproxy(kNotKnown)["fix_type"], 1);
  EXPECT_EQ(mavproxy(kNotKnown)["lat"], 0);
}

TEST(PositionAnswer, OfAStepWhoseAgeIsForgottenTellsNoPosition) {
  const PositionTime forgotten{kTime.captured_us, std::nullopt};
  EXPECT_EQ(position_response(kKnown, format_of({{"format", "command_int"}}), forgotten).status, 204);
  EXPECT_EQ(mavproxy(kKnown, {}, forgotten)["fix_type"], 1);
}

}  // namespace
}  // namespace roadfix::api
