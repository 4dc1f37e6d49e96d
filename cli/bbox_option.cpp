#include "cli/bbox_option.hpp"

#include <vector>

namespace roadfix::cli {

void add_bbox_option(CLI::App& command, const std::string& what, std::optional<GeoBox>& box) {
  const auto take = [&box](const std::vector<double>& bounds) {
    box = GeoBox{{bounds[1], bounds[0]}, {bounds[3], eastern_side_deg(bounds[0], bounds[2])}};
    if (box->empty()) throw CLI::ValidationError("--bbox", "west must lie below east, and south below north");
  };
  command
      .add_option_function<std::vector<double>>(
          "--bbox", take, what + ": WEST,SOUTH,EAST,NORTH in degrees (WEST above EAST across the antimeridian)")
      ->delimiter(',')
      ->expected(4);
}

}  // namespace roadfix::cli
