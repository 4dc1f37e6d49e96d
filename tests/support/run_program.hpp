// The real program `roadfix`, run to its end.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace roadfix::testing {

struct ProgramResult {
  int code = 0;
  std::string out;
  std::string err;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// `arguments` as a shell reads them. What it prints passes through files in `folder`.
inline ProgramResult run_program(const std::filesystem::path& folder, const std::string& arguments) {
  const auto out = folder / "out";
  const auto err = folder / "err";
  const std::string command = ROADFIX_PROGRAM " " + arguments + " >" + out.string() + " 2>" + err.string();
  const int status = std::system(command.c_str());
  return {WEXITSTATUS(status), text_of(out), text_of(err)};
}

}  // namespace roadfix::testing
