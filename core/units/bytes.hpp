// Bytes of files and pictures, and the same ones as characters: both refer to what they are made of.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace roadfix {

using Bytes = std::span<const std::uint8_t>;

inline Bytes bytes_of(std::string_view characters) {
  return {reinterpret_cast<const std::uint8_t*>(characters.data()), characters.size()};
}

inline std::string_view characters_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The number that up to 8 bytes are, the most significant first.
constexpr std::int64_t big_endian(Bytes bytes) {
  std::int64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

}  // namespace roadfix
