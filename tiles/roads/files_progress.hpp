// How far several files are read that are one source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/units/progress.hpp"

namespace roadfix {

/// Each file counts by its size on disk; one whose size is not known (a folder) as next to nothing.
class FilesProgress {
 public:
  /// `all` gets thousandths of all files, each once, or is empty.
  FilesProgress(const std::vector<std::string>& paths, OnProgress all);

  /// For the file with this index, in whatever it counts; empty where `all` is. Not to be used after *this has ended.
  OnProgress of(std::size_t file);

 private:
  std::vector<double> before_;  ///< bytes before each file, and of all
  OnProgress all_;
  std::int64_t told_ = -1;
};

}  // namespace roadfix
