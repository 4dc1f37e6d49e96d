#include "cli/output_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/file_beside.hpp"

namespace roadfix::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void unwritable(const fs::path& file, int reason) {
  throw IoFailure("result-unwritable",
                  fmt::format("{} cannot be written ({}): check that its folder exists, may be written to, and is not "
                              "full",
                              file.string(), std::generic_category().message(reason)));
}

/// Devices, such as /dev/null and /dev/stdout, take what several outputs say.
bool same_file(const fs::path& a, const fs::path& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code none;  // where one of them does not exist yet
  if (fs::exists(a, none) && !fs::is_regular_file(a, none)) return false;
  return fs::equivalent(a, b, none) || fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal();
}

/// Throws as write_file, naming `file`.
void write(const fs::path& path, std::string_view bytes, const fs::path& file) {
  errno = 0;
  std::ofstream out(path, std::ios::binary);
  if (!out) unwritable(file, errno);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) unwritable(file, errno);
}

}  // namespace

void require_name(const fs::path& output) {
  if (output != "-") return;
  throw InvalidInput(
      "target-is-dash",
      "- stands for no output here: name a file or folder (./- for one of this name), or /dev/stdout for "
      "a text");
}

void require_apart(std::initializer_list<fs::path> outputs, std::initializer_list<fs::path> inputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    require_name(*output);
    const auto is_it = [&](const fs::path& other) { return same_file(*output, other); };
    if (std::any_of(inputs.begin(), inputs.end(), is_it)) {
      throw InvalidInput("target-is-source",
                         fmt::format("{} is read, and would be overwritten: name another file", output->string()));
    }
    if (std::any_of(outputs.begin(), output, is_it)) {
      throw InvalidInput("target-given-twice",
                         fmt::format("{} would hold two results: name a file for each", output->string()));
    }
  }
}

bool is_replaced(const fs::path& file) {
  const std::string path = fs::absolute(file).lexically_normal().string();
  std::error_code none;  // where the file does not exist yet
  return !path.starts_with("/dev/") && !path.starts_with("/proc/") && !is_standard_output(file) &&
         (!fs::exists(file, none) || fs::is_regular_file(file, none));
}

void write_file(const fs::path& file, std::string_view bytes) {
  if (!is_replaced(file)) return write(file, bytes, file);
  require_writable({file});
  FileBeside whole(behind_links(file));
  errno = 0;
  if (!std::ofstream(whole.unfinished())) {
    if (errno == ENOSPC || errno == EDQUOT) unwritable(file, errno);
    return write(file, bytes, file);  // the folder takes no new files
  }
  write(whole.unfinished(), bytes, file);
  try {
    if (fs::exists(whole.target())) fs::permissions(whole.unfinished(), fs::status(whole.target()).permissions());
    whole.finish();
  } catch (const fs::filesystem_error& error) {
    unwritable(file, error.code().value());
  }
}

bool is_standard_output(const fs::path& file) {
  std::error_code none;  // where the file does not exist yet
  return fs::equivalent(file, "/dev/stdout", none);
}

std::FILE* printed_beside(std::initializer_list<fs::path> outputs) {
  return std::any_of(outputs.begin(), outputs.end(), is_standard_output) ? stderr : stdout;
}

void require_folder(const fs::path& folder) {
  if (folder.empty()) return;
  require_name(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) unwritable(folder, error.value());
}

void require_writable(std::initializer_list<fs::path> files) {
  for (const fs::path& file : files) {
    if (file.empty()) continue;
    const fs::path target = behind_links(file);
    const bool is_new = !fs::exists(target);
    errno = 0;
    if (!std::ofstream(target, std::ios::binary | std::ios::app)) unwritable(file, errno);
    if (is_new) fs::remove(target);
  }
}

}  // namespace roadfix::cli
