// Which commands of a MAVLink mission lead the vehicle somewhere (MAV_CMD, mavlink.io/en/messages/common.html).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace roadfix::routes {

inline constexpr std::int64_t kReturnToLaunch = 20;

/// Parameters 5 and 6 are a place that it flies to: waypoints, loiters, landings, take-offs, splines, deliveries.
inline bool leads_somewhere(std::int64_t command) {
  constexpr std::array<std::int64_t, 12> kFlownTo{16, 17, 18, 19, 21, 22, 31, 36, 82, 84, 85, 94};
  return std::ranges::find(kFlownTo, command) != kFlownTo.end();
}

}  // namespace roadfix::routes
