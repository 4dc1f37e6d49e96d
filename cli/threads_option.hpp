// The option of how much a command does at the same time.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace roadfix::cli {

/// 1 to 1024, as many as the machine has processors unless given. `name` is "--threads" or "--jobs"; `threads` must
/// live as long as the command.
void add_threads_option(CLI::App& command, const std::string& name, int& threads, const std::string& what);

}  // namespace roadfix::cli
