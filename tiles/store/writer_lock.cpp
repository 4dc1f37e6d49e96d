#include "tiles/store/writer_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/units/error.hpp"
#include "tiles/store/file_identity.hpp"

namespace roadfix {
namespace {

/// The last holder may have removed the file between our open and our lock.
bool still_there(int descriptor, const std::filesystem::path& path) {
  const std::optional<FileIdentity> held = identity_of(descriptor);
  return held && held == identity_of(path);
}

}  // namespace

WriterLock::WriterLock(const std::filesystem::path& map) : path_(map.string() + "-writer") {
  while (true) {
    descriptor_ = open(path_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      throw IoFailure("map-not-writable", fmt::format("{}: cannot write beside the map: {}. Check that the folder "
                                                      "exists and may be written to",
                                                      map.string(), std::strerror(errno)));
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      close(descriptor_);
      if (reason != EWOULDBLOCK) {
        throw IoFailure("map-not-writable",
                        fmt::format("{}: the map cannot be locked against other writers: {}. Put it on a file system "
                                    "that has locks",
                                    map.string(), std::strerror(reason)));
      }
      throw InUse("map-in-use",
                  fmt::format("{}: another process is writing this map. Wait until it has ended", map.string()));
    }
    if (still_there(descriptor_, path_)) return;
    close(descriptor_);
  }
}

WriterLock::~WriterLock() {
  unlink(path_.c_str());
  close(descriptor_);
}

}  // namespace roadfix
