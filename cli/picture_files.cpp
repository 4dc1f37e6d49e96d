#include "cli/picture_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>

#include "cli/terminal.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> pictures_in(const fs::path& folder, std::initializer_list<const char*> endings) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string ending = lower_case(entry.path().extension().string());
    const bool hidden = entry.path().filename().native().starts_with('.');  // what a Mac keeps beside a file, too
    if (!hidden && entry.is_regular_file() && std::ranges::find(endings, ending) != endings.end())
      files.push_back(entry.path());
  }
  if (files.empty()) {
    throw InvalidInput("no-pictures",
                       fmt::format("{}: no picture ({}) in this folder", folder.string(), fmt::join(endings, ", ")));
  }
  std::ranges::sort(files);
  return files;
}

/// Why `work` could not be done; nullopt where it was.
std::optional<std::string> reason_against(const fs::path& file, const std::function<void(const fs::path&)>& work) {
  try {
    work(file);
    return std::nullopt;
  } catch (const Error& error) {
    if (!is_about_input(error)) throw;
    return fmt::format("{} [{}]", error.what(), error.code());
  }
}

}  // namespace

Pictures pictures_of(const std::vector<std::string>& names, std::initializer_list<const char*> endings) {
  Pictures pictures{.files = {}, .several = names.size() > 1};
  for (const std::string& name : names) {
    if (!fs::is_directory(name)) {
      pictures.files.emplace_back(name);
      continue;
    }
    pictures.several = true;
    const auto found = pictures_in(name, endings);
    pictures.files.insert(pictures.files.end(), found.begin(), found.end());
  }
  return pictures;
}

void require_not_empty(const fs::path& file) {
  if (!fs::is_regular_file(file) || fs::file_size(file) > 0) return;
  throw InvalidInput("image-damaged", fmt::format("{}: the file is empty: copy it again", file.string()));
}

void say_left_out(const fs::path& file, std::string_view reason) {
  const std::string named = file.string() + ": ";
  if (reason.starts_with(named)) reason.remove_prefix(named.size());
  fmt::print(stderr, "{} is left out: {}\n", file.string(), reason);
}

std::size_t for_each_picture(const Pictures& pictures, const char* task, bool prints,
                             const std::function<void(const fs::path&)>& work) {
  const std::vector<fs::path>& files = pictures.files;
  if (!pictures.several) {
    work(files.front());
    return 0;
  }
  std::optional<Progress> progress;
  if (!prints || isatty(STDOUT_FILENO) == 0) progress.emplace(task, "pictures");
  std::size_t left_out = 0;
  std::int64_t done = 0;
  for (const fs::path& file : files) {
    if (progress) progress->update(done++, static_cast<std::int64_t>(files.size()));
    if (const auto reason = reason_against(file, work)) {
      say_left_out(file, *reason);
      ++left_out;
    }
    std::fflush(stdout);  // for whoever reads along; main says whether all of it found room
  }
  if (progress) progress->update(done, done);
  return left_out;
}

void require_none(std::size_t left_out, std::size_t of) {
  if (left_out == 0) return;
  throw InvalidInput(
      "pictures-left-out",
      fmt::format("{} of {} pictures were left out, as said above; the others have their result", left_out, of));
}

}  // namespace roadfix::cli
