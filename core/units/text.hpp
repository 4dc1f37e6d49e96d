// Texts that machines compare.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadfix {

/// Letters A to Z become small, whatever the locale; all other bytes stay.
std::string lower_case(std::string_view text);

/// Without the spaces and tabs around it.
std::string_view trimmed(std::string_view text);

/// The first bytes and "..." where the text is longer: for messages that repeat what a client sent.
std::string shortened(std::string_view text, std::size_t most);

/// Without the mark that spreadsheets write before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

/// All of the text as a number, written as in C++ and in decimal; nullopt for anything else, and for what the type does
/// not hold. "inf" and "nan" are numbers of floating types.
template <typename Number>
std::optional<Number> as_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// The trimmed parts between separators, one more than there are of them.
std::vector<std::string_view> split(std::string_view text, char separator);

/// These parts as numbers; nullopt where one is not finite or no number.
template <typename Number = double>
std::optional<std::vector<Number>> numbers_in(std::string_view text, char separator) {
  std::vector<Number> numbers;
  for (const std::string_view part : split(text, separator)) {
    const auto number = as_number<Number>(part);
    if (!number || !std::isfinite(static_cast<double>(*number))) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace roadfix
