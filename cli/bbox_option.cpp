#include "cli/bbox_option.hpp"

#include <span>
#include <vector>

namespace roadfix::cli {

void add_bbox_option(CLI::App& command, const std::string& what, std::optional<GeoBox>& box) {
  const auto take = [&box](const std::vector<double>& bounds) {
    box = geo_box_of(std::span<const double, 4>(bounds));
    if (box->empty()) throw CLI::ValidationError("--bbox", "west must lie below east, and south below north");
  };
  command
      .add_option_function<std::vector<double>>(
          "--bbox", take, what + ": WEST,SOUTH,EAST,NORTH in degrees (WEST above EAST across the antimeridian)")
      ->delimiter(',')
      ->expected(4);
}

}  // namespace roadfix::cli
