#include "server/autopilot/gps_input.hpp"

#include <cmath>

#include "server/autopilot/mavlink_messages.hpp"

namespace roadfix::autopilot {
namespace {

constexpr MavlinkMessage kGpsInput{232, 151};

// GPS_INPUT_IGNORE_FLAGS
constexpr std::uint16_t kAltitude = 1;
constexpr std::uint16_t kHorizontalAccuracy = 64;
constexpr std::uint16_t kAlways =
    2 | 4 | 8 | 16 | 32 | 128;  // dilutions, velocities and their accuracy, vertical accuracy

constexpr std::int64_t kGpsEpochUs = 315'964'800'000'000;
constexpr std::int64_t kLeapUs = 18'000'000;  // GPS ahead of UTC, since 2017
constexpr std::int64_t kWeekUs = 604'800'000'000;

std::uint16_t yaw_cdeg(Angle heading) {
  const auto cdeg = static_cast<std::uint16_t>(std::lround(100.0 * heading.compass_degrees()) % 36000);
  return cdeg == 0 ? 36000 : cdeg;
}

}  // namespace

GpsInput gps_input(const PositionReport& report, int satellites) {
  GpsInput input;
  input.time_usec = static_cast<std::uint64_t>(report.captured_us);
  if (report.captured_us >= kGpsEpochUs) {
    const std::int64_t gps_us = report.captured_us - kGpsEpochUs + kLeapUs;
    input.time_week = static_cast<std::uint16_t>(gps_us / kWeekUs);
    input.time_week_ms = static_cast<std::uint32_t>(gps_us % kWeekUs / 1000);
  }
  input.ignore_flags = kAlways | kAltitude | kHorizontalAccuracy;
  input.fix_type = 1;
  if (!report.position) return input;
  const Position& position = *report.position;
  input.fix_type = report.altitude_msl_m ? 3 : 2;
  input.lat = degrees_e7(position.at.lat_deg);
  input.lon = degrees_e7(position.at.lon_deg);
  if (report.altitude_msl_m) {
    input.alt = static_cast<float>(*report.altitude_msl_m);
    input.ignore_flags &= static_cast<std::uint16_t>(~kAltitude);
  }
  if (position.sigma_m) {
    input.horiz_accuracy = static_cast<float>(*position.sigma_m);
    input.ignore_flags &= static_cast<std::uint16_t>(~kHorizontalAccuracy);
  }
  input.satellites_visible = static_cast<std::uint8_t>(satellites);
  if (position.heading) input.yaw = yaw_cdeg(*position.heading);
  return input;
}

std::string to_packet(const GpsInput& input, const MavlinkSender& sender) {
  MavlinkPayload payload;
  payload.add(input.time_usec).add(input.time_week_ms).add(input.lat).add(input.lon).add(input.alt);
  for (int i = 0; i < 6; ++i) payload.add(0.0F);  // hdop, vdop, vn, ve, vd, speed_accuracy
  payload.add(input.horiz_accuracy)
      .add(0.0F)  // vert_accuracy
      .add(input.ignore_flags)
      .add(input.time_week)
      .add(std::uint8_t{0})  // gps_id
      .add(input.fix_type)
      .add(input.satellites_visible)
      .add(input.yaw);
  return mavlink_packet(kGpsInput, payload, sender);
}

nlohmann::json to_json(const GpsInput& input) {
  return {{"time_usec", input.time_usec},
          {"gps_id", 0},
          {"ignore_flags", input.ignore_flags},
          {"time_week_ms", input.time_week_ms},
          {"time_week", input.time_week},
          {"fix_type", input.fix_type},
          {"lat", input.lat},
          {"lon", input.lon},
          {"alt", input.alt},
          {"hdop", 0.0},
          {"vdop", 0.0},
          {"vn", 0.0},
          {"ve", 0.0},
          {"vd", 0.0},
          {"speed_accuracy", 0.0},
          {"horiz_accuracy", input.horiz_accuracy},
          {"vert_accuracy", 0.0},
          {"satellites_visible", input.satellites_visible},
          {"yaw", input.yaw}};
}

}  // namespace roadfix::autopilot
