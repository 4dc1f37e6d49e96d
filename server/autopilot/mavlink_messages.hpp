// A position as the MAVLink messages that autopilots fuse (common.xml of 2026-07). A report without a position is no
// message at all.
#pragma once

#include <optional>
#include <string>

#include "server/autopilot/mavlink_frame.hpp"
#include "server/autopilot/position_report.hpp"

namespace roadfix::autopilot {

/// Degrees times 10^7, rounded.
std::int32_t degrees_e7(double degrees);

/// GLOBAL_POSITION_SENSOR (296), source VISION, to all components of the sender's system; heights are NaN where they
/// are not known. PX4 fuses that of the sensor of EKF2_AGP0_ID.
std::optional<std::string> global_position_sensor(const PositionReport& report, const MavlinkSender& sender);

/// MAV_CMD_EXTERNAL_POSITION_ESTIMATE (43003) in COMMAND_INT (75), to the autopilot of the sender's system. ArduPilot's
/// EKF3 takes it. The time of transmission starts anew every 250 s, as the command demands.
std::optional<std::string> external_position_estimate(const PositionReport& report, const MavlinkSender& sender);

}  // namespace roadfix::autopilot
