// Times as other programs read them.
#pragma once

#include <chrono>
#include <string>

namespace roadfix {

/// By ISO 8601 and RFC 3339, in UTC and to the millisecond below: "2023-11-14T22:13:20.123Z". Of years 1 to 9999.
std::string utc_text(std::chrono::system_clock::time_point time);

}  // namespace roadfix
