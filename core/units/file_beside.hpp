// Files that are whole or as they were before, whatever happens while they are written.
#pragma once

#include <filesystem>

namespace roadfix {

/// A file that is written beside another and takes its place when it is finished. Whatever is not finished is removed.
class FileBeside {
 public:
  /// Under a name that nobody else has and that ends like the target's, as some programs look at endings.
  explicit FileBeside(const std::filesystem::path& target);
  /// Under a name in the folder of the target, from which it removes what a process that was killed left.
  FileBeside(std::filesystem::path target, std::filesystem::path unfinished);
  ~FileBeside();
  FileBeside(const FileBeside&) = delete;
  FileBeside& operator=(const FileBeside&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& unfinished() const { return unfinished_; }
  /// Once it is written and closed: from then on the target is the new file, also after a power cut. Throws
  /// std::filesystem::filesystem_error; the target is as it was then.
  void finish();

 private:
  void remove_unfinished() const;

  std::filesystem::path target_;
  std::filesystem::path unfinished_;
};

}  // namespace roadfix
