#include "tiles/store/file_identity.hpp"

#include <sys/stat.h>

namespace roadfix {

std::optional<FileIdentity> identity_of(const std::filesystem::path& path) {
  struct stat file {};
  return stat(path.c_str(), &file) == 0 ? std::optional(FileIdentity{file.st_dev, file.st_ino}) : std::nullopt;
}

std::optional<FileStamp> stamp_of(const std::filesystem::path& path) {
  struct stat file {};
  if (stat(path.c_str(), &file) != 0) return std::nullopt;
  return FileStamp{{file.st_dev, file.st_ino}, file.st_size, {file.st_ctim.tv_sec, file.st_ctim.tv_nsec}};
}

std::optional<FileIdentity> identity_of(int descriptor) {
  struct stat file {};
  return fstat(descriptor, &file) == 0 ? std::optional(FileIdentity{file.st_dev, file.st_ino}) : std::nullopt;
}

}  // namespace roadfix
