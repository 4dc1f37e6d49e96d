// The position of a fix or of a step of a track in the form that the client asked for: JSON, or what autopilots read.
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/angle.hpp"
#include "server/api/fields.hpp"
#include "server/autopilot/mavlink_frame.hpp"
#include "server/http/message.hpp"

namespace roadfix::api {

/// Names that say how an answer is given; they change nothing of what is found.
const std::vector<std::string>& position_fields();

inline constexpr Range kAltitude{-1000.0, 50'000.0};

/// Height above the sea ("alt_m").
std::optional<double> told_altitude_m(const Fields& fields);

enum class PositionEncoding { kJson, kGlobalPositionSensor, kCommandInt, kGpsInput, kMavproxy, kNmea };

struct PositionFormat {
  PositionEncoding encoding = PositionEncoding::kJson;
  std::string_view type;  ///< "application/json", ...
  std::optional<double> altitude_msl_m;
  Angle camera_yaw;  ///< where the frame's upper edge points, clockwise from the vehicle's nose
  int satellites = 0;
  autopilot::MavlinkSender sender;

  bool is_json() const { return encoding == PositionEncoding::kJson; }
};

/// By "format", else by Accept. Throws InvalidField, InvalidInput ("not-acceptable").
PositionFormat parse_position_format(const http::Request& request, const Fields& fields);

struct PositionTime {
  std::int64_t captured_us = 0;
  /// Without it there is no position: an old one would be taken for a new one.
  std::optional<std::chrono::microseconds> processing;
};

/// `answer` is that of to_json for a fix or an estimate of a track: only where it has a "pose" at its top there is a
/// position. 204 where the format has no word for that there is none. Not for is_json().
http::Response position_response(const nlohmann::json& answer, const PositionFormat& format, const PositionTime& time);

}  // namespace roadfix::api
