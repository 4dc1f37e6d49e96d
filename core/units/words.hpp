// What text calls the values of an enumeration: one table to read and to write by.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <optional>
#include <string_view>

namespace roadfix {

template <typename E>
struct Word {
  std::string_view word;
  E value;
};

/// The table must have the value.
template <typename E, std::size_t N>
constexpr std::string_view word_of(const std::array<Word<E>, N>& words, E value) {
  const auto found = std::ranges::find(words, value, &Word<E>::value);
  assert(found != words.end());
  return found->word;
}

/// nullopt where the table lacks the word.
template <typename E, std::size_t N>
constexpr std::optional<E> value_of(const std::array<Word<E>, N>& words, std::string_view word) {
  const auto found = std::ranges::find(words, word, &Word<E>::word);
  return found == words.end() ? std::nullopt : std::optional(found->value);
}

/// In their order.
template <typename E, std::size_t N>
constexpr std::array<std::string_view, N> words_in(const std::array<Word<E>, N>& words) {
  std::array<std::string_view, N> names{};
  std::ranges::transform(words, names.begin(), &Word<E>::word);
  return names;
}

}  // namespace roadfix
