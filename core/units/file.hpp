// Whole files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace roadfix {

/// All bytes of a file; nullopt where it cannot be read, as a folder cannot.
std::optional<std::string> read_file(const std::filesystem::path& file);

}  // namespace roadfix
