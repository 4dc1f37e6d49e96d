#include "core/units/shell_word.hpp"

#include <algorithm>

namespace roadfix {
namespace {

/// Whatever is no letter, digit or one of the few signs that mean nothing to any shell. Bytes of UTF-8 are letters.
bool is_plain(char c) {
  constexpr std::string_view kSigns = "_-./,:=+@%";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         static_cast<unsigned char>(c) >= 0x80 || kSigns.find(c) != std::string_view::npos;
}

}  // namespace

std::string shell_word(std::string_view text) {
  if (!text.empty() && std::ranges::all_of(text, is_plain)) return std::string(text);
  std::string word = "'";
  for (const char c : text) {
    // Nothing is special between these quotes but the quote that ends them.
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  return word + "'";
}

}  // namespace roadfix
