#include "core/png/png_text.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace roadfix {
namespace {

constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kNumber = 4;
constexpr std::size_t kAroundData = 3 * kNumber;  // of a chunk: length and type before its data, checksum behind
constexpr std::size_t kHeaderData = 13;
constexpr std::size_t kHeaderEnd = kSignature.size() + kAroundData + kHeaderData;

std::uint32_t number_at(std::span<const std::uint8_t> bytes) {
  std::uint32_t number = 0;
  for (const std::uint8_t byte : bytes.first(kNumber)) number = number << 8U | byte;
  return number;
}

void append(std::uint32_t number, std::vector<std::uint8_t>& bytes) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

/// Of a chunk's type and data.
std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
}

std::vector<std::uint8_t> with_chunk(std::span<const std::uint8_t> png, std::string_view type, std::string_view keyword,
                                     std::string_view between, std::string_view text) {
  assert(png.size() > kHeaderEnd && !keyword.empty() && keyword.size() < 80);
  std::vector<std::uint8_t> typed;
  for (const std::string_view part : {type, keyword, between, text})
    typed.insert(typed.end(), part.begin(), part.end());
  const auto header = png.first(kHeaderEnd);
  std::vector<std::uint8_t> result(header.begin(), header.end());
  result.reserve(png.size() + typed.size() + 2 * kNumber);
  append(static_cast<std::uint32_t>(typed.size() - kNumber), result);
  result.insert(result.end(), typed.begin(), typed.end());
  append(checksum(typed), result);
  result.insert(result.end(), png.begin() + kHeaderEnd, png.end());
  return result;
}

bool is_type(std::span<const std::uint8_t> type, std::string_view name) { return std::ranges::equal(type, name); }

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kSignature.size() && std::ranges::equal(bytes.first(kSignature.size()), kSignature);
}

std::vector<std::uint8_t> with_text(std::span<const std::uint8_t> png, std::string_view keyword,
                                    std::string_view text) {
  return with_chunk(png, "tEXt", keyword, {"\0", 1}, text);
}

std::vector<std::uint8_t> with_utf8_text(std::span<const std::uint8_t> png, std::string_view keyword,
                                         std::string_view text) {
  constexpr std::string_view kPlain("\0\0\0\0\0", 5);  // end of the keyword, not compressed, of no said language
  return with_chunk(png, "iTXt", keyword, kPlain, text);
}

std::optional<std::string> text_in(std::span<const std::uint8_t> png, std::string_view keyword) {
  if (!is_png(png)) return {};
  std::span<const std::uint8_t> rest = png.subspan(kSignature.size());
  while (rest.size() >= kAroundData && number_at(rest) <= rest.size() - kAroundData) {
    const std::size_t size = number_at(rest);
    const auto type = rest.subspan(kNumber, kNumber);
    const auto data = rest.subspan(2 * kNumber, size);
    if (is_type(type, "IDAT")) return {};
    const bool named =
        size > keyword.size() && data[keyword.size()] == 0 && std::ranges::equal(data.first(keyword.size()), keyword);
    if (is_type(type, "tEXt") && named &&
        number_at(rest.subspan(2 * kNumber + size)) == checksum(rest.subspan(kNumber, kNumber + size))) {
      const auto text = data.subspan(keyword.size() + 1);
      return std::string(text.begin(), text.end());
    }
    rest = rest.subspan(kAroundData + size);
  }
  return {};
}

}  // namespace roadfix
