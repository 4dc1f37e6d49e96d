#include "cli/terrain_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace roadfix::cli {

std::string heights_text(const TerrainStatus& terrain) {
  return fmt::format("cells of {} m, {:.0f} to {:.0f} m above the sea, known on {:.0f} % of the map",
                     terrain.terrain->geometry.cell_m, terrain.heights.lowest_m, terrain.heights.highest_m,
                     std::floor(100.0 * terrain.known_share));
}

}  // namespace roadfix::cli
