#include "tiles/store/file_identity.hpp"

#include <sys/stat.h>

namespace roadfix {

std::optional<FileIdentity> identity_of(const std::filesystem::path& path) {
  struct stat file {};
  return stat(path.c_str(), &file) == 0 ? std::optional(FileIdentity{file.st_dev, file.st_ino}) : std::nullopt;
}

std::optional<FileIdentity> identity_of(int descriptor) {
  struct stat file {};
  return fstat(descriptor, &file) == 0 ? std::optional(FileIdentity{file.st_dev, file.st_ino}) : std::nullopt;
}

}  // namespace roadfix
