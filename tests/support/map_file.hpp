// Cells of a test written as a map file.
#pragma once

#include <filesystem>

#include "core/grid/road_grid.hpp"
#include "tests/support/put_block.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix::testing {

/// One source named "town" that holds the grid.
inline void write_map_file(const std::filesystem::path& path, const RoadGrid& grid, double registration_sigma_m,
                           const UtmZone& zone = UtmZone::from_epsg(32634).value()) {
  MapWriter writer(path, {zone, grid.geometry.cell_m});
  const SourceRecord record{.name = "town",
                            .content = SourceContent::kRoads,
                            .location = "town.geojson",
                            .fingerprint = "town",
                            .method = "drawn",
                            .provenance = {.licence = "CC0", .registration_sigma_m = registration_sigma_m}};
  for (const TileIndex block : writer.begin_source(record, tiles_covering(grid.geometry), false)) {
    const GridGeometry geometry = tile_geometry(block, grid.geometry.cell_m);
    RoadGrid tile = RoadGrid::unobserved(geometry);
    paste(grid.cells, tile.cells, grid.geometry.origin.col - geometry.origin.col,
          grid.geometry.origin.row - geometry.origin.row);
    put_block(writer, record.name, block, tile.cells);
  }
  writer.finish_source(record.name);
}

}  // namespace roadfix::testing
