// A position as GPS_INPUT (232): as a MAVLink packet, and as the JSON that MAVProxy's module GPSInput takes over UDP.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "server/autopilot/mavlink_frame.hpp"
#include "server/autopilot/position_report.hpp"

namespace roadfix::autopilot {

/// As in common.xml of 2026-07. Velocities and dilutions of precision are always flagged as to be ignored.
struct GpsInput {
  std::uint64_t time_usec = 0;     ///< PositionReport::captured_us
  std::uint32_t time_week_ms = 0;  ///< since the begin of `time_week`
  std::int32_t lat = 0;            ///< degrees E7
  std::int32_t lon = 0;
  float alt = 0.0F;                ///< metres above mean sea level
  float horiz_accuracy = 0.0F;     ///< metres, Position::sigma_m
  std::uint16_t ignore_flags = 0;  ///< of the fields that say nothing
  std::uint16_t time_week = 0;     ///< of GPS time; 0 with time_week_ms where the report's time is not since 1970
  std::uint8_t fix_type = 0;       ///< 1 = none, 2 = without height, 3 = with height
  std::uint8_t satellites_visible = 0;
  std::uint16_t yaw = 0;  ///< degrees E2, 36000 = north, 0 = not known
};

/// `satellites` is what the autopilot shall believe; a map has none. A report without a position has fix_type 1 and
/// everything ignored. The time is that of the frame.
GpsInput gps_input(const PositionReport& report, int satellites);

std::string to_packet(const GpsInput& input, const MavlinkSender& sender);
/// Every field, as MAVProxy keeps those of the message before.
nlohmann::json to_json(const GpsInput& input);

}  // namespace roadfix::autopilot
