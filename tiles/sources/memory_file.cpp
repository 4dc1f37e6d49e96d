#include "tiles/sources/memory_file.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <atomic>

namespace roadfix {

MemoryFile::MemoryFile(std::string_view ending) {
  static std::atomic<std::uint64_t> next{0};
  path_ = fmt::format("/vsimem/roadfix-{}{}", next++, ending);
}

MemoryFile::MemoryFile(std::string_view ending, std::span<const std::uint8_t> bytes) : MemoryFile(ending) {
  auto* data = const_cast<GByte*>(bytes.data());  // GDAL writes into files that are opened to be written
  VSIFCloseL(VSIFileFromMemBuffer(path_.c_str(), data, bytes.size(), FALSE));
}

MemoryFile::~MemoryFile() { VSIUnlink(path_.c_str()); }

std::string MemoryFile::bytes() const {
  vsi_l_offset size = 0;
  const GByte* data = VSIGetMemFileBuffer(path_.c_str(), &size, FALSE);
  return data == nullptr ? std::string()
                         : std::string(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace roadfix
