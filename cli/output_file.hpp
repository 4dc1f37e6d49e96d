// Files that a command leaves behind.
#pragma once

#include <filesystem>
#include <string_view>

namespace roadfix::cli {

/// Replaces the file. Throws IoFailure "result-unwritable" unless all of it was written.
void write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace roadfix::cli
