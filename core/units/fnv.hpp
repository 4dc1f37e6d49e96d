// FNV-1a of 64 bits (draft-eastlake-fnv): tells contents apart, guards against no one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace roadfix {

class Fnv1a64 {
 public:
  void add(std::string_view bytes);

  std::uint64_t value() const { return value_; }
  /// 16 hexadecimal digits.
  std::string text() const;

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// The hash of these bytes alone, as text().
std::string fnv1a64(std::string_view bytes);

}  // namespace roadfix
