// A file of GDAL's memory file system, under a name of its own, gone with this object.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace roadfix {

class MemoryFile {
 public:
  /// To be written. The name ends like that: ".tif".
  explicit MemoryFile(std::string_view ending);
  /// To be read only. The bytes are not copied and must outlive it.
  MemoryFile(std::string_view ending, std::span<const std::uint8_t> bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const char* path() const { return path_.c_str(); }
  /// What was written, once the data set is closed; empty where nothing was.
  std::string bytes() const;

 private:
  std::string path_;
};

}  // namespace roadfix
