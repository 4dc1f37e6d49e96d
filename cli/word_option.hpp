// Options whose words are those of a table, and nothing else.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/words.hpp"

namespace roadfix::cli {

/// `words` are named in the help and where another one is given. `value` must live as long as the command, and may be
/// an optional one.
template <typename E, std::size_t N, typename Value>
CLI::Option* add_word_option(CLI::App& command, const std::string& name, const std::array<Word<E>, N>& words,
                             Value& value, const std::string& what) {
  const std::array<std::string_view, N> known = words_in(words);
  return command
      .add_option_function<std::string>(
          name, [&value, words](const std::string& word) { value = value_of(words, word).value(); }, what)
      ->check(CLI::IsMember(std::vector<std::string>(known.begin(), known.end())));
}

}  // namespace roadfix::cli
