// A position as NMEA 0183 sentences, for what reads nothing else.
#pragma once

#include <string>
#include <string_view>

#include "server/autopilot/position_report.hpp"

namespace roadfix::autopilot {

/// Exclusive or of the characters between $ and *.
std::uint8_t nmea_checksum(std::string_view sentence);

/// GGA, RMC and GST, each with checksum and line end. The talker is GP, which every reader takes; the quality says that
/// the position is estimated (GGA 6, RMC mode E). Time and date are UTC, empty where the report's time is not since
/// 1970. Without a position GGA says 0, RMC says V, and there is no GST.
std::string nmea_sentences(const PositionReport& report, int satellites);

}  // namespace roadfix::autopilot
