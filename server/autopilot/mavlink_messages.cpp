#include "server/autopilot/mavlink_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadfix::autopilot {
namespace {

constexpr MavlinkMessage kGlobalPositionSensor{296, 158};
constexpr MavlinkMessage kCommandInt{75, 158};
constexpr std::uint16_t kExternalPositionEstimate = 43003;
constexpr std::uint8_t kSourceVision = 2;
constexpr std::uint8_t kFrameGlobal = 0;
constexpr std::uint8_t kAutopilot = 1;
constexpr std::uint8_t kEveryComponent = 0;
constexpr std::int64_t kWrapUs = 250'000'000;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

float or_unknown(const std::optional<double>& value) { return value ? static_cast<float>(*value) : kUnknown; }

std::int64_t sent_us(const PositionReport& report) { return report.captured_us + report.processing.count(); }

}  // namespace

std::int32_t degrees_e7(double degrees) { return static_cast<std::int32_t>(std::llround(1e7 * degrees)); }

std::optional<std::string> global_position_sensor(const PositionReport& report, const MavlinkSender& sender) {
  if (!report.position) return std::nullopt;
  const auto processing =
      std::clamp<std::int64_t>(report.processing.count(), 0, std::numeric_limits<std::uint32_t>::max());
  MavlinkPayload payload;
  payload.add(static_cast<std::uint64_t>(sent_us(report)))
      .add(static_cast<std::uint32_t>(processing))
      .add(degrees_e7(report.position->at.lat_deg))
      .add(degrees_e7(report.position->at.lon_deg))
      .add(kUnknown)  // above the ellipsoid
      .add(or_unknown(report.altitude_msl_m))
      .add(or_unknown(report.position->sigma_m))
      .add(kUnknown)  // 1 sigma of the height
      .add(sender.system)
      .add(kEveryComponent)
      .add(sender.sensor)
      .add(kSourceVision)
      .add(std::uint8_t{0});  // healthy, not the vehicle's own estimate
  return mavlink_packet(kGlobalPositionSensor, payload, sender);
}

std::optional<std::string> external_position_estimate(const PositionReport& report, const MavlinkSender& sender) {
  if (!report.position) return std::nullopt;
  MavlinkPayload payload;
  payload.add(static_cast<float>(1e-6 * static_cast<double>(sent_us(report) % kWrapUs)))
      .add(static_cast<float>(1e-6 * static_cast<double>(report.processing.count())))
      .add(or_unknown(report.position->sigma_m))
      .add(0.0F)
      .add(degrees_e7(report.position->at.lat_deg))
      .add(degrees_e7(report.position->at.lon_deg))
      .add(kUnknown)
      .add(kExternalPositionEstimate)
      .add(sender.system)
      .add(kAutopilot)
      .add(kFrameGlobal)
      .add(std::uint8_t{0})
      .add(std::uint8_t{0});
  return mavlink_packet(kCommandInt, payload, sender);
}

}  // namespace roadfix::autopilot
