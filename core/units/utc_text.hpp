// Times as other programs read them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace roadfix {

/// By ISO 8601 and RFC 3339, in UTC and to the millisecond below: "2023-11-14T22:13:20.123Z". Of years 1 to 9999.
std::string utc_text(std::chrono::system_clock::time_point time);

/// The year 2000, in microseconds since 1970: times before it are those of a vehicle that does not know the date.
inline constexpr std::int64_t kFirstDateUs = 946'684'800'000'000;

}  // namespace roadfix
