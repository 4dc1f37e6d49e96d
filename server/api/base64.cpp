#include "server/api/base64.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNone = 255;

constexpr std::array<std::uint8_t, 256> kValues = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNone);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return values;
}();

}  // namespace

std::string base64_encoded(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = std::uint32_t{bytes[i]} << 16;
    if (n > 1) group |= std::uint32_t{bytes[i + 1]} << 8;
    if (n > 2) group |= bytes[i + 2];
    for (std::size_t k = 0; k < 4; ++k) text.push_back(k <= n ? kAlphabet[(group >> (18 - 6 * k)) & 63] : '=');
  }
  return text;
}

Base64Result base64_decoded(std::string_view text) {
  std::size_t length = text.size();
  if (length % 4 == 0 && text.ends_with('=')) --length;
  if (text.size() % 4 == 0 && text.ends_with("==")) --length;
  Base64Result result;
  result.bytes.reserve(length / 4 * 3 + 2);
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < length; ++i) {
    const std::uint8_t value = kValues[static_cast<unsigned char>(text[i])];
    if (value == kNone) return {{}, i};
    group = group << 6 | value;
    if (i % 4 == 3) {
      for (const int shift : {16, 8, 0}) result.bytes.push_back(static_cast<std::uint8_t>(group >> shift));
      group = 0;
    }
  }
  const std::size_t rest = length % 4;
  if (rest == 1) return {{}, length - 1};
  if (rest >= 2) result.bytes.push_back(static_cast<std::uint8_t>(group >> (rest == 2 ? 4 : 10)));
  if (rest == 3) result.bytes.push_back(static_cast<std::uint8_t>(group >> 2));
  return result;
}

std::vector<std::uint8_t> bytes_of_base64(const std::string& field, std::string_view text) {
  Base64Result result = base64_decoded(text);
  if (result.bad_byte) {
    throw http::InvalidField(
        "bad-base64", field,
        fmt::format(
            "'{}' is not base64 of RFC 4648 section 4, on one line and without a data: URL in front: character {} "
            "does not belong there",
            field, *result.bad_byte),
        result.bad_byte);
  }
  return std::move(result.bytes);
}

}  // namespace roadfix::api
