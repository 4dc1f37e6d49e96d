// A SQLite file behind the back of who owns it: to damage it, or to see what it holds.
#pragma once

#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tiles/store/sqlite.hpp"

namespace roadfix::testing {

/// Failures are std::runtime_error: a test that meets one is wrong.
inline sqlite::Connection open_sqlite(const std::filesystem::path& path,
                                      sqlite::Access access = sqlite::Access::kReadWrite) {
  return {path, access, [](const std::filesystem::path& file, sqlite::Failure, const std::string& detail) {
            return std::make_exception_ptr(std::runtime_error(file.string() + ": " + detail));
          }};
}

}  // namespace roadfix::testing
