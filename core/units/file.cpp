#include "core/units/file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

/// `reason`: the errno of a file that cannot be read.
std::optional<std::string> bytes_of(const std::filesystem::path& file, int& reason) {
  reason = EISDIR;
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return std::nullopt;
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  const bool opened = in.is_open();
  std::string bytes;
  constexpr std::size_t kAtATime = 1 << 20;  // a pipe does not tell its size
  while (in) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kAtATime);
    in.read(&bytes[before], kAtATime);
    bytes.resize(before + static_cast<std::size_t>(in.gcount()));
  }
  reason = errno == 0 ? EIO : errno;
  return opened && !in.bad() ? std::optional(std::move(bytes)) : std::nullopt;
}

}  // namespace

std::optional<std::string> read_file(const std::filesystem::path& file) {
  int reason = 0;
  return bytes_of(file, reason);
}

std::string read_named_file(const std::filesystem::path& file) {
  int reason = 0;
  std::optional<std::string> bytes = bytes_of(file, reason);
  if (bytes) return *std::move(bytes);
  throw NotFound("file-not-found", fmt::format("{} cannot be read ({}): check its name and the permission to read it",
                                               file.string(), std::generic_category().message(reason)));
}

std::filesystem::path behind_links(std::filesystem::path path) {
  constexpr int kMaxLinks = 40;  // as the operating system has it
  std::error_code error;
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(path, error); ++i) {
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  }
  return path;
}

std::optional<std::int64_t> free_bytes_beside(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto space = std::filesystem::space(file.has_parent_path() ? file.parent_path() : ".", unknown);
  if (unknown) return std::nullopt;
  return static_cast<std::int64_t>(space.available);
}

}  // namespace roadfix
