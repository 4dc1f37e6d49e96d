// How long the peer of a connection may take, and how much it may send before a body.
#pragma once

#include <chrono>
#include <cstddef>

namespace roadfix::http {

/// See ConnectionLimits::grace.
inline constexpr std::size_t kLeastBytesPerS = 4 << 10;

struct ConnectionLimits {
  std::chrono::milliseconds head{10'000};  ///< from the first byte of a request to the end of its headers
  std::chrono::milliseconds body{60'000};  ///< for the whole body
  std::chrono::milliseconds write{30'000};
  /// While others wait for a thread, a peer that is slower than kLeastBytesPerS over the grace is let go of.
  std::chrono::milliseconds grace{2'000};
  std::size_t head_bytes = 64 << 10;
};

}  // namespace roadfix::http
