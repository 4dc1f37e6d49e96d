#include "core/units/fnv.hpp"

#include <fmt/format.h>

namespace roadfix {

void Fnv1a64::add(std::string_view bytes) {
  for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
}

std::string Fnv1a64::text() const { return fmt::format("{:016x}", value_); }

std::string fnv1a64(std::string_view bytes) {
  Fnv1a64 hash;
  hash.add(bytes);
  return hash.text();
}

}  // namespace roadfix
