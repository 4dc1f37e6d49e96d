#include "cli/route_input.hpp"

#include <fmt/format.h>

#include <string>

namespace roadfix::cli {

routes::Route route_with_notes(const std::filesystem::path& file) {
  routes::Route route = routes::read_route(file);
  for (const std::string& part : route.left_out) {
    fmt::print(stderr, "note: {}: left out {}\n", file.string(), part);
  }
  return route;
}

}  // namespace roadfix::cli
