// One writer per map: an advisory lock on a file beside it (M.gpkg-writer), which the kernel releases when the process
// dies. The map file itself is not locked this way: closing a second descriptor of it would drop SQLite's own locks.
#pragma once

#include <filesystem>

namespace roadfix {

class WriterLock {
 public:
  /// Throws InUse ("map-in-use") when another writer holds the map, IoFailure where no file can be made.
  explicit WriterLock(const std::filesystem::path& map);
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace roadfix
