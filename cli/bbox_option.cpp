#include "cli/bbox_option.hpp"

#include <span>
#include <vector>

namespace roadfix::cli {

void add_bbox_option(CLI::App& command, const std::string& what, std::optional<GeoBox>& box) {
  const auto take = [&box](const std::vector<double>& bounds) {
    box = told_box(std::span<const double, 4>(bounds));
    if (!box) {
      throw CLI::ValidationError("--bbox",
                                 "west must lie below east, and south below north: longitudes from -360 to 360 and "
                                 "latitudes from -90 to 90 degrees");
    }
  };
  command
      .add_option_function<std::vector<double>>(
          "--bbox", take, what + ": WEST,SOUTH,EAST,NORTH in degrees (WEST above EAST across the antimeridian)")
      ->delimiter(',')
      ->expected(4);
}

}  // namespace roadfix::cli
