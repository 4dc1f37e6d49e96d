// Packets against those of a public MAVLink implementation (node_mavlink.cjs), sentences against published ones.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <vector>

#include "server/autopilot/gps_input.hpp"
#include "server/autopilot/mavlink_messages.hpp"
#include "server/autopilot/nmea.hpp"

namespace roadfix::autopilot {
namespace {

using nlohmann::json;

constexpr MavlinkSender kSender{7, 197, 41, 3};

/// Of 2025-11-21 11:34:56.25 UTC, a quarter of a second ago.
PositionReport known() {
  PositionReport report;
  report.position = Position{{37.7632123, -122.2571987}, Angle::degrees(131.4), 2.5};
  report.altitude_msl_m = 512.25;
  report.captured_us = 1'763'724'896'250'000;
  report.processing = std::chrono::milliseconds(250);
  return report;
}

PositionReport hardly_known() {
  PositionReport report = known();
  report.position->sigma_m.reset();
  report.position->heading = Angle::degrees(-0.001);
  report.altitude_msl_m.reset();
  report.processing = {};
  return report;
}

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return text;
}

std::string expected(const char* name) {
  std::ifstream file(ROADFIX_MAVLINK_VECTORS);
  return json::parse(file).at(name);
}

TEST(Mavlink, PacketsOfGpsInputAreThoseOfAPublicImplementation) {
  EXPECT_EQ(hex(to_packet(gps_input(known(), 10), kSender)), expected("gps_input_3d"));
  EXPECT_EQ(hex(to_packet(gps_input(hardly_known(), 0), kSender)), expected("gps_input_2d"));
  PositionReport none;
  none.captured_us = 12'000'000;
  EXPECT_EQ(hex(to_packet(gps_input(none, 10), kSender)), expected("gps_input_none")) << "and no satellites";
}

TEST(Mavlink, PacketsOfPositionsAreThoseOfAPublicImplementation) {
  EXPECT_EQ(hex(*global_position_sensor(known(), kSender)), expected("global_position_sensor"));
  EXPECT_EQ(hex(*global_position_sensor(hardly_known(), kSender)), expected("global_position_sensor_unknown"));
  EXPECT_EQ(hex(*external_position_estimate(known(), kSender)), expected("command_int"));
  EXPECT_EQ(hex(*external_position_estimate(hardly_known(), kSender)), expected("command_int_unknown"));
}

TEST(Mavlink, NothingIsSentOfAPositionThatIsNotKnown) {
  PositionReport none = known();
  none.position.reset();
  EXPECT_FALSE(global_position_sensor(none, kSender));
  EXPECT_FALSE(external_position_estimate(none, kSender));
  const GpsInput input = gps_input(none, 10);
  EXPECT_EQ(input.fix_type, 1);
  EXPECT_EQ(input.lat, 0);
  EXPECT_EQ(input.ignore_flags, 255);
}

/// The check value of CRC-16/MCRF4XX in the catalogue of parametrised CRC algorithms (reveng.sourceforge.io).
TEST(Mavlink, ChecksumIsTheOneOfTheCatalogue) { EXPECT_EQ(mavlink_crc("123456789"), 0x6f91); }

/// https://mavlink.io/en/guide/serialization.html#crc_extra: a checksum over the name of the message and the types and
/// names of its fields, in wire order and without extensions. So these are the fields that the receiver expects.
TEST(Mavlink, ChecksumsOfTheDefinitionsAreThoseOfTheirFields) {
  const auto crc_extra = [](const std::string& message,
                            const std::vector<std::pair<std::string, std::string>>& fields) {
    std::string text = message + " ";
    for (const auto& [type, names] : fields) {
      std::size_t at = 0;
      while (at < names.size()) {
        const std::size_t end = std::min(names.find(' ', at), names.size());
        text.append(type).append(" ").append(names, at, end - at).append(" ");
        at = end + 1;
      }
    }
    const std::uint16_t crc = mavlink_crc(text);
    return (crc & 0xff) ^ (crc >> 8);
  };
  EXPECT_EQ(crc_extra("GLOBAL_POSITION_SENSOR", {{"uint64_t", "time_usec"},
                                                 {"uint32_t", "processing_time"},
                                                 {"int32_t", "lat lon"},
                                                 {"float", "alt_ellipsoid alt eph epv"},
                                                 {"uint8_t", "target_system target_component id source flags"}}),
            158);
  EXPECT_EQ(crc_extra("GPS_INPUT", {{"uint64_t", "time_usec"},
                                    {"uint32_t", "time_week_ms"},
                                    {"int32_t", "lat lon"},
                                    {"float", "alt hdop vdop vn ve vd speed_accuracy horiz_accuracy vert_accuracy"},
                                    {"uint16_t", "ignore_flags time_week"},
                                    {"uint8_t", "gps_id fix_type satellites_visible"}}),
            151);
  EXPECT_EQ(crc_extra("COMMAND_INT", {{"float", "param1 param2 param3 param4"},
                                      {"int32_t", "x y"},
                                      {"float", "z"},
                                      {"uint16_t", "command"},
                                      {"uint8_t", "target_system target_component frame current autocontinue"}}),
            158);
}

TEST(Mavlink, DegreesAreRoundedAtBothEnds) {
  EXPECT_EQ(degrees_e7(90.0), 900'000'000);
  EXPECT_EQ(degrees_e7(-180.0), -1'800'000'000);
  EXPECT_EQ(degrees_e7(-0.00000006), -1);
}

TEST(Mavproxy, TakesEveryFieldOfGpsInput) {
  const json text = to_json(gps_input(known(), 10));
  EXPECT_EQ(text["lat"], 377'632'123);
  EXPECT_EQ(text["lon"], -1'222'571'987);
  EXPECT_EQ(text["fix_type"], 3);
  EXPECT_EQ(text["alt"], 512.25);
  EXPECT_EQ(text["horiz_accuracy"], 2.5);
  EXPECT_EQ(text["ignore_flags"], 190);
  EXPECT_EQ(text["time_week"], 2393);
  EXPECT_EQ(text["time_week_ms"], 473'714'250);
  EXPECT_EQ(text["yaw"], 13'140);
  // Those that MAVProxy/modules/mavproxy_GPSInput.py sends on; it keeps what a message leaves out.
  for (const char* name :
       {"time_usec", "gps_id", "ignore_flags", "time_week_ms", "time_week", "fix_type", "lat", "lon", "alt", "hdop",
        "vdop", "vn", "ve", "vd", "speed_accuracy", "horiz_accuracy", "vert_accuracy", "satellites_visible"}) {
    EXPECT_TRUE(text[name].is_number()) << name;
  }
}

/// The example that all descriptions of NMEA 0183 give.
TEST(Nmea, ChecksumIsTheOneOfTheTextbook) {
  EXPECT_EQ(nmea_checksum("GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,"), 0x47);
}

std::string with_checksums(std::initializer_list<std::string> bodies) {
  std::string text;
  for (const std::string& body : bodies) text += fmt::format("${}*{:02X}\r\n", body, nmea_checksum(body));
  return text;
}

TEST(Nmea, SentencesTellAnEstimatedPosition) {
  PositionReport report = known();
  report.position->at = {48.0 + 7.038 / 60.0, 11.0 + 31.0 / 60.0};
  EXPECT_EQ(nmea_sentences(report, 8), with_checksums({"GPGGA,113456.25,4807.03800,N,01131.00000,E,6,08,,512.2,M,,,,",
                                                       "GPRMC,113456.25,A,4807.03800,N,01131.00000,E,,,211125,,,E",
                                                       "GPGST,113456.25,,,,,2.5,2.5,"}));
}

TEST(Nmea, SentencesKeepTheirFieldsWhereLittleIsKnown) {
  PositionReport report = hardly_known();
  report.position->at = {-0.99999999, -122.5};
  report.captured_us = 12'000'000;  // since the vehicle's start
  EXPECT_EQ(nmea_sentences(report, 0), with_checksums({"GPGGA,,0100.00000,S,12230.00000,W,6,00,,,,,,,",
                                                       "GPRMC,,A,0100.00000,S,12230.00000,W,,,,,,E"}));
  report.position.reset();
  EXPECT_EQ(nmea_sentences(report, 0), with_checksums({"GPGGA,,,,,,0,00,,,,,,,", "GPRMC,,V,,,,,,,,,,N"}));
}

}  // namespace
}  // namespace roadfix::autopilot
