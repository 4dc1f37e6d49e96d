#include "tiles/roads/files_progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

namespace roadfix {
namespace {

double bytes_of(const std::string& path) {
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  return unknown ? 1.0 : std::max(1.0, static_cast<double>(bytes));
}

}  // namespace

FilesProgress::FilesProgress(const std::vector<std::string>& paths, OnProgress all)
    : before_{0.0}, all_(std::move(all)) {
  for (const std::string& path : paths) before_.push_back(before_.back() + bytes_of(path));
}

OnProgress FilesProgress::of(std::size_t file) {
  if (!all_) return {};
  return [this, first = before_.at(file), next = before_.at(file + 1)](std::int64_t done, std::int64_t total) {
    constexpr std::int64_t kWhole = 1000;
    const double share = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
    const auto read = static_cast<std::int64_t>(std::lerp(first, next, share) / before_.back() * kWhole);
    if (read > std::exchange(told_, std::max(told_, read))) all_(read, kWhole);
  };
}

}  // namespace roadfix
