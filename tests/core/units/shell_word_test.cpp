#include "core/units/shell_word.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

namespace roadfix {
namespace {

TEST(ShellWord, LeavesPlainNamesAsTheyAre) {
  for (const char* name : {"city.gpkg", "/srv/maps/a-b_c.gpkg", "K\xC3\xB6ln", "a,b:c=d+e@f%g"}) {
    EXPECT_EQ(shell_word(name), name);
  }
}

TEST(ShellWord, QuotesWhatAShellWouldTakeForItsOwn) {
  EXPECT_EQ(shell_word("my city.gpkg"), "'my city.gpkg'");
  EXPECT_EQ(shell_word("it's"), R"('it'\''s')");
  EXPECT_EQ(shell_word(""), "''");
}

/// What the shell of this machine makes of it.
std::string read_by_shell(const std::string& word) {
  std::string said;
  FILE* const shell = ::popen(("printf %s " + word).c_str(), "r");
  std::array<char, 256> piece{};
  for (std::size_t n = 1; n > 0; said.append(piece.data(), n)) n = std::fread(piece.data(), 1, piece.size(), shell);
  EXPECT_EQ(::pclose(shell), 0) << word;
  return said;
}

TEST(ShellWord, IsReadByAShellAsItWas) {
  for (const char* text : {"a b", "it's", "\"q\"", "$HOME", "`id`", "a\\b", "x;y|z&", "*?[~]#!", "(a)<b>{c}",
                           "two\nlines", "~", "''", "tab\there"}) {
    EXPECT_EQ(read_by_shell(shell_word(text)), text);
  }
}

}  // namespace
}  // namespace roadfix
