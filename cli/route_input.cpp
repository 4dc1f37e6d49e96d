#include "cli/route_input.hpp"

#include <fmt/format.h>

#include <string>

#include "core/routes/route.hpp"

namespace roadfix::cli {

std::vector<LatLon> route_with_notes(const std::filesystem::path& file) {
  const routes::Route route = routes::read_route(file);
  for (const std::string& part : route.left_out) {
    fmt::print(stderr, "note: {}: left out {}\n", file.string(), part);
  }
  return route.places;
}

}  // namespace roadfix::cli
