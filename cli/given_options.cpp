#include "cli/given_options.hpp"

#include <nlohmann/json.hpp>

namespace roadfix::cli {

nlohmann::json given_options(const CLI::App& command) {
  nlohmann::json given = nlohmann::json::object();
  for (const CLI::Option* option : command.get_options()) {
    if (!option->empty()) given[option->get_name()] = option->results();
  }
  return given;
}

}  // namespace roadfix::cli
