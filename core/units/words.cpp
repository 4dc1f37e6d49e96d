#include "core/units/words.hpp"

#include <bit>
#include <cassert>
#include <cstring>

namespace roadfix {

static_assert(std::endian::native == std::endian::little);
static_assert(kWordBytes == sizeof(std::uint64_t));

void put_word(std::vector<std::byte>& bytes, std::uint64_t word) {
  const auto* first = reinterpret_cast<const std::byte*>(&word);
  bytes.insert(bytes.end(), first, first + kWordBytes);
}

std::uint64_t word_at(std::span<const std::byte> bytes, std::size_t index) {
  assert((index + 1) * kWordBytes <= bytes.size());
  std::uint64_t word = 0;
  std::memcpy(&word, bytes.data() + index * kWordBytes, kWordBytes);
  return word;
}

}  // namespace roadfix
