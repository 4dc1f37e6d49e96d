// What tells a file from another one of its name.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <utility>

namespace roadfix {

using FileIdentity = std::pair<dev_t, ino_t>;

/// Of the file that has the name now; nullopt where there is none.
std::optional<FileIdentity> identity_of(const std::filesystem::path& path);
/// Of an open file, which may have lost its name.
std::optional<FileIdentity> identity_of(int descriptor);

}  // namespace roadfix
