// Runs the real command as a child that a test can kill, and tells what it used.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace roadfix::testing {

struct ChildResult {
  bool killed = false;  ///< by us
  int code = 0;         ///< exit code, if it ended by itself
  std::string err;
  std::string out;
  long peak_memory_kib = 0;
};

/// Starts the program with the arguments and sends `signal` after the delay, unless it has ended by then. A delay of
/// zero means never.
ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder, std::chrono::microseconds kill_after = {}, int signal = 9);

}  // namespace roadfix::testing
