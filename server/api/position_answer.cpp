#include "server/api/position_answer.hpp"

#include <algorithm>
#include <array>

#include "server/api/media.hpp"
#include "server/autopilot/gps_input.hpp"
#include "server/autopilot/mavlink_messages.hpp"
#include "server/autopilot/nmea.hpp"

namespace roadfix::api {
namespace {

/// In the order of PositionEncoding.
constexpr std::array<Media, 6> kFormats{{{"json", "application/json"},
                                         {"global_position_sensor", "application/x-mavlink-global-position-sensor"},
                                         {"command_int", "application/x-mavlink-command-int"},
                                         {"gps_input", "application/x-mavlink-gps-input"},
                                         {"mavproxy", "application/x-mavproxy-gps-input+json"},
                                         {"nmea", "application/x-nmea-0183"}}};

/// 1 sigma. No message says how sure a yaw is, and an autopilot that steers by it takes it for that of a compass.
constexpr double kLeastSureYawDeg = 10.0;

/// Answers have the heading of the frame, autopilots want that of the vehicle.
std::optional<autopilot::Position> position_of(const nlohmann::json& answer, Angle camera_yaw) {
  if (!answer.contains("pose")) return std::nullopt;
  const nlohmann::json& pose = answer.at("pose");
  const std::array<double, 2> sigma_m = answer.at("sigma_m");
  autopilot::Position position{{pose.at("lat"), pose.at("lon")}, std::nullopt, std::max(sigma_m[0], sigma_m[1])};
  if (answer.at("heading_sigma_deg") <= kLeastSureYawDeg) {
    position.heading = Angle::degrees(pose.at("heading_deg")) - camera_yaw;
  }
  return position;
}

void read_id(const Fields& fields, const std::string& name, std::uint8_t& id) {
  if (const auto told = fields.optional_integer(name, 1, 255)) id = static_cast<std::uint8_t>(*told);
}

/// nullopt where there is nothing to be said.
std::optional<std::string> encoded(const autopilot::PositionReport& report, const PositionFormat& format) {
  switch (format.encoding) {
    case PositionEncoding::kJson:
      break;
    case PositionEncoding::kGlobalPositionSensor:
      return autopilot::global_position_sensor(report, format.sender);
    case PositionEncoding::kCommandInt:
      return autopilot::external_position_estimate(report, format.sender);
    case PositionEncoding::kGpsInput:
      return autopilot::to_packet(autopilot::gps_input(report, format.satellites), format.sender);
    case PositionEncoding::kMavproxy:
      return autopilot::to_json(autopilot::gps_input(report, format.satellites)).dump();
    case PositionEncoding::kNmea:
      return autopilot::nmea_sentences(report, format.satellites);
  }
  return std::nullopt;
}

}  // namespace

const std::vector<std::string>& position_fields() {
  static const std::vector<std::string> kFields{"format", "alt_m",  "camera_yaw_deg", "satellites",
                                                "system", "sensor", "component"};
  return kFields;
}

std::optional<double> told_altitude_m(const Fields& fields) { return fields.optional_number("alt_m", kAltitude); }

PositionFormat parse_position_format(const http::Request& request, const Fields& fields) {
  const Media& media = media_asked_for(request, fields, kFormats);
  PositionFormat format;
  format.encoding = static_cast<PositionEncoding>(&media - kFormats.data());
  format.type = media.type;
  format.altitude_msl_m = told_altitude_m(fields);
  format.camera_yaw = fields.optional_angle("camera_yaw_deg", kDegrees).value_or(Angle());
  format.satellites = fields.optional_integer("satellites", 0, 99).value_or(0);
  read_id(fields, "system", format.sender.system);
  read_id(fields, "sensor", format.sender.sensor);
  read_id(fields, "component", format.sender.component);
  return format;
}

http::Response position_response(const nlohmann::json& answer, const PositionFormat& format, const PositionTime& time) {
  autopilot::PositionReport report{std::nullopt, format.altitude_msl_m, time.captured_us, {}};
  if (time.processing) {
    report.position = position_of(answer, format.camera_yaw);
    report.processing = *time.processing;
  }
  http::Response response{204, {}, {}};
  if (auto message = encoded(report, format)) response = {200, std::string(format.type), std::move(*message)};
  response.headers.emplace_back("Roadfix-Status", answer.at("status"));
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

}  // namespace roadfix::api
