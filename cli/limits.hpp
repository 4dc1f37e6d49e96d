// What a command takes at most: more than a service lets one request ask for (server/api/limits.hpp), since whoever
// runs it shares the machine with nobody.
#pragma once

#include <cstddef>
#include <cstdint>

namespace roadfix::cli {

inline constexpr std::int64_t kMaxPixels = 400'000'000;  ///< of a frame, before and after rectification
inline constexpr double kMaxCells = 25e6;                ///< of several frames laid together
inline constexpr std::size_t kMaxFrames = 64;            ///< laid together

}  // namespace roadfix::cli
