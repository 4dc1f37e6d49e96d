#include "core/units/file_beside.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace roadfix {
namespace {

namespace fs = std::filesystem;

std::string own_name(const fs::path& target) {
  static std::atomic<int> count = 0;
  return "unfinished-" + std::to_string(getpid()) + "-" + std::to_string(++count) + "-" + target.filename().string();
}

std::error_code last_error() { return {errno, std::generic_category()}; }

/// What was written to it is on disk then.
std::error_code sync(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return last_error();
  const std::error_code error = fsync(descriptor) == 0 ? std::error_code() : last_error();
  close(descriptor);
  return error;
}

}  // namespace

FileBeside::FileBeside(const fs::path& target) : FileBeside(target, target.parent_path() / own_name(target)) {}

FileBeside::FileBeside(fs::path target, fs::path unfinished)
    : target_(std::move(target)), unfinished_(std::move(unfinished)) {
  remove_unfinished();
}

FileBeside::~FileBeside() { remove_unfinished(); }

void FileBeside::remove_unfinished() const {
  std::error_code ignored;  // it need not be there
  fs::remove(unfinished_, ignored);
}

void FileBeside::finish() {
  const std::error_code error = sync(unfinished_);
  if (error && error != std::errc::invalid_argument) {  // of file systems that sync nothing
    throw fs::filesystem_error("cannot be synced", unfinished_, error);
  }
  fs::rename(unfinished_, target_);
  const fs::path folder = target_.parent_path();
  sync(folder.empty() ? "." : folder);  // some file systems do not open folders; the rename itself has been done
}

}  // namespace roadfix
