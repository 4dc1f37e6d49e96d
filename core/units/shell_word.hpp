// Names within the commands that messages propose.
#pragma once

#include <string>
#include <string_view>

namespace roadfix {

/// What a POSIX shell reads as this one word: in quotes where it holds blanks, quotes or anything else that a shell
/// takes for its own, as it is otherwise.
std::string shell_word(std::string_view text);

}  // namespace roadfix
