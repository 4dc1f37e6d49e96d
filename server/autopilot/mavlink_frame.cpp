#include "server/autopilot/mavlink_frame.hpp"

namespace roadfix::autopilot {
namespace {

constexpr char kMagic = static_cast<char>(0xfd);

}  // namespace

std::uint16_t mavlink_crc(std::string_view bytes) {
  std::uint16_t crc = 0xffff;
  for (const char c : bytes) {
    auto byte = static_cast<std::uint8_t>(static_cast<std::uint8_t>(c) ^ (crc & 0xff));
    byte = static_cast<std::uint8_t>(byte ^ (byte << 4));
    crc = static_cast<std::uint16_t>((crc >> 8) ^ (byte << 8) ^ (byte << 3) ^ (byte >> 4));
  }
  return crc;
}

std::string mavlink_packet(const MavlinkMessage& message, const MavlinkPayload& payload, const MavlinkSender& sender) {
  const std::size_t last = payload.bytes().find_last_not_of('\0');
  const std::string_view sent = std::string_view(payload.bytes()).substr(0, last == std::string::npos ? 1 : last + 1);
  MavlinkPayload head;
  head.add(static_cast<std::uint8_t>(sent.size()))
      .add(std::uint8_t{0})  // incompatibility flags: not signed
      .add(std::uint8_t{0})  // compatibility flags
      .add(sender.sequence)
      .add(sender.system)
      .add(sender.component)
      .add(static_cast<std::uint8_t>(message.id & 0xff))
      .add(static_cast<std::uint8_t>(message.id >> 8 & 0xff))
      .add(static_cast<std::uint8_t>(message.id >> 16 & 0xff));
  std::string packet = head.bytes();
  packet.append(sent);
  MavlinkPayload crc;
  crc.add(mavlink_crc(packet + static_cast<char>(message.crc_extra)));
  return kMagic + packet + crc.bytes();
}

}  // namespace roadfix::autopilot
