// MAVLink 2 packets (https://mavlink.io/en/guide/serialization.html), unsigned.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace roadfix::autopilot {

/// CRC-16/MCRF4XX over the bytes, as MAVLink wants it ("X.25").
std::uint16_t mavlink_crc(std::string_view bytes);

/// Fields in wire order, little endian.
class MavlinkPayload {
 public:
  template <std::integral T>
  MavlinkPayload& add(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff));
    }
    return *this;
  }
  MavlinkPayload& add(float value) { return add(std::bit_cast<std::uint32_t>(value)); }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

struct MavlinkSender {
  std::uint8_t system = 1;       ///< the vehicle's
  std::uint8_t component = 197;  ///< MAV_COMP_ID_VISUAL_INERTIAL_ODOMETRY
  std::uint8_t sequence = 0;     ///< counts the packets of one link
  std::uint8_t sensor = 1;       ///< in messages of sensors; 0 is none to PX4
};

struct MavlinkMessage {
  std::uint32_t id = 0;
  std::uint8_t crc_extra = 0;
};

/// The packet; zeros at the end of the payload are left out, as the protocol demands.
std::string mavlink_packet(const MavlinkMessage& message, const MavlinkPayload& payload, const MavlinkSender& sender);

}  // namespace roadfix::autopilot
