// Numbers of eight bytes, little endian, in states that are kept as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace roadfix {

inline constexpr std::size_t kWordBytes = 8;

void put_word(std::vector<std::byte>& bytes, std::uint64_t word);
/// The word that begins at byte index * kWordBytes; it must be within the bytes.
std::uint64_t word_at(std::span<const std::byte> bytes, std::size_t index);

}  // namespace roadfix
