// Whole files, where they are, and the room for them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace roadfix {

/// All bytes of a file; nullopt where it cannot be read, as a folder cannot.
std::optional<std::string> read_file(const std::filesystem::path& file);

/// The same of a file that has to be there. Throws NotFound "file-not-found", which tells why the system does not give
/// it.
std::string read_named_file(const std::filesystem::path& file);

/// What a link leads to, though it may not be there.
std::filesystem::path behind_links(std::filesystem::path path);

/// As free_bytes_beside() tells it.
using FreeBytes = std::function<std::optional<std::int64_t>(const std::filesystem::path& file)>;

/// What the disk of a file's folder has free for this process; nullopt where it does not tell.
std::optional<std::int64_t> free_bytes_beside(const std::filesystem::path& file);

}  // namespace roadfix
