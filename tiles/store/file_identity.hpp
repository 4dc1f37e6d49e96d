// What tells a file from another one of its name.
#pragma once

#include <sys/types.h>

#include <ctime>
#include <filesystem>
#include <optional>
#include <utility>

namespace roadfix {

using FileIdentity = std::pair<dev_t, ino_t>;

/// Of the file that has the name now; nullopt where there is none.
std::optional<FileIdentity> identity_of(const std::filesystem::path& path);
/// Of an open file, which may have lost its name.
std::optional<FileIdentity> identity_of(int descriptor);

/// Another one when something was written to the file, or another file has its name.
struct FileStamp {
  FileIdentity identity;
  off_t size = 0;
  std::pair<time_t, long> changed;  ///< seconds and nanoseconds; of one tick of the kernel's clock all the same

  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// Of the file that has the name now; nullopt where there is none.
std::optional<FileStamp> stamp_of(const std::filesystem::path& path);

}  // namespace roadfix
