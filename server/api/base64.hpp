// RFC 4648 base64, standard alphabet.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roadfix::api {

std::string base64_encoded(std::span<const std::uint8_t> bytes);

struct Base64Result {
  std::vector<std::uint8_t> bytes;
  std::optional<std::size_t> bad_byte;  ///< position of the first character that does not belong there
};

/// Padding may be left out; nothing else may be in the text.
Base64Result base64_decoded(std::string_view text);

/// The same of the field of a request. Throws InvalidField "bad-base64" with the position.
std::vector<std::uint8_t> bytes_of_base64(const std::string& field, std::string_view text);

}  // namespace roadfix::api
