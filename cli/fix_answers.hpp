// How `roadfix fix` tells an answer.
#pragma once

#include <filesystem>
#include <string>

#include "core/locate/fix.hpp"

namespace roadfix::cli {

/// On standard output, for a person.
void print_text(const Fix& fix);

/// Of a table of answers, in the words of the service; with the end of its line.
std::string fix_columns();
/// Its row for a picture. A place stands in that of a fix alone.
std::string row_of(const std::filesystem::path& picture, const Fix& fix);

}  // namespace roadfix::cli
