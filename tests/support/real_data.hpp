// Real data that is no part of the repository: tests that need it skip with a message where it is not there.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace roadfix::testing {

/// ../shared/data beside the project, or the folder that ROADFIX_DATA names.
inline std::filesystem::path real_data(const std::string& name) {
  if (const char* folder = std::getenv("ROADFIX_DATA")) return std::filesystem::path(folder) / name;
  return std::filesystem::path(ROADFIX_SOURCE_DIR).parent_path() / "shared" / "data" / name;
}

}  // namespace roadfix::testing
