#include "cli/threads_option.hpp"

#include <algorithm>
#include <thread>

namespace roadfix::cli {

int processors() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

void add_threads_option(CLI::App& command, const std::string& name, int& threads, const std::string& what) {
  threads = processors();
  command.add_option(name, threads, what)->capture_default_str()->check(CLI::Range(1, 1024));
}

}  // namespace roadfix::cli
