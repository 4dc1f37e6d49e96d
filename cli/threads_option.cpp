#include "cli/threads_option.hpp"

#include "core/units/parallel_for.hpp"

namespace roadfix::cli {

void add_threads_option(CLI::App& command, const std::string& name, int& threads, const std::string& what) {
  threads = processors();
  command.add_option(name, threads, what)->capture_default_str()->check(CLI::Range(1, 1024));
}

}  // namespace roadfix::cli
