#include "tiles/store/map_description.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/grid/lattice.hpp"
#include "tiles/store/create_map.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/shift_table.hpp"
#include "tiles/store/tile_matrix.hpp"

namespace roadfix {
namespace {

using sqlite::Connection;
using sqlite::number;
using sqlite::Statement;

void check_lattice(Connection& map, const MapSettings& settings, std::vector<MapProblem>& problems) {
  Statement set(map,
                "SELECT count(*) FROM gpkg_tile_matrix_set WHERE table_name = 'road_probability' AND srs_id = ?1 AND "
                "min_x = 0 AND min_y = 0 AND max_x = ?2 AND max_y = ?3");
  set.with(settings.zone.epsg(), kLattice.max.east_m, kLattice.max.north_m).step();
  bool right = set.integer(0) == 1 && lattice_has(map, settings);
  Statement level(map,
                  "SELECT count(*) FROM gpkg_tile_matrix WHERE table_name = 'road_probability' AND zoom_level = ?1 AND "
                  "matrix_width = ?2 AND matrix_height = ?3 AND tile_width = ?4 AND tile_height = ?4 AND "
                  "pixel_x_size = ?5 AND pixel_y_size = ?5");
  for (int zoom = kCoarsestZoom; zoom <= zoom_of(settings.cell_m); ++zoom) {
    level.with(zoom, matrix_width(zoom), matrix_height(zoom), kTileCells, cell_of_zoom(zoom)).step();
    right = right && level.integer(0) == 1;
  }
  if (right) return;
  problems.push_back({"lattice-wrong",
                      "gpkg_tile_matrix_set and gpkg_tile_matrix are not those of the zone and cell size of the map. "
                      "Restore the map from a copy"});
}

/// As create_map writes them.
void check_reference(Connection& map, const MapSettings& settings, std::vector<MapProblem>& problems) {
  Statement contents(map,
                     "SELECT count(*) FROM gpkg_contents c JOIN gpkg_spatial_ref_sys s ON s.srs_id = c.srs_id WHERE "
                     "c.table_name = 'road_probability' AND c.data_type = '2d-gridded-coverage' AND c.srs_id = ?1 AND "
                     "s.organization = 'EPSG' AND s.organization_coordsys_id = ?1 AND s.definition = ?2");
  const std::string definition = wkt_of(settings.zone);
  contents.with(settings.zone.epsg(), definition).step();
  if (contents.integer(0) == 1) return;
  problems.push_back(
      {"reference-wrong", fmt::format("gpkg_contents and gpkg_spatial_ref_sys do not say that the map is a grid in "
                                      "EPSG:{}: other programs show it elsewhere or as something else. Restore the map "
                                      "from a copy",
                                      settings.zone.epsg())});
}

/// As create_map writes it.
void check_coverage(Connection& map, std::vector<MapProblem>& problems) {
  const std::int64_t right =
      number(map,
             "SELECT count(*) FROM gpkg_2d_gridded_coverage_ancillary WHERE tile_matrix_set_name = "
             "'road_probability' AND datatype = 'integer' AND scale = 1.0 / 254 AND offset = 0.0 AND precision "
             "= 1.0 / 254 AND data_null = 65535 AND grid_cell_encoding = 'grid-value-is-area'");
  if (right == 1) return;
  problems.push_back({"coverage-wrong",
                      "gpkg_2d_gridded_coverage_ancillary is not as a map has it (integers with a scale of 1/254, an "
                      "offset of 0 and 65535 for nothing): other programs misread the map. Restore it from a copy"});
}

void check_tile_scales(Connection& map, std::vector<MapProblem>& problems) {
  const std::int64_t wrong = number(
      map,
      "SELECT (SELECT count(*) FROM road_probability t LEFT JOIN gpkg_2d_gridded_tile_ancillary a ON a.tpudt_name = "
      "'road_probability' AND a.tpudt_id = t.id WHERE a.scale IS NOT 1.0 OR a.offset IS NOT 0.0) + "
      "(SELECT count(*) FROM gpkg_2d_gridded_tile_ancillary WHERE tpudt_name = 'road_probability' AND tpudt_id NOT IN "
      "(SELECT id FROM road_probability))");
  if (wrong == 0) return;
  problems.push_back(
      {"ancillary-wrong", fmt::format("{} rows of gpkg_2d_gridded_tile_ancillary are missing, wrong or left over: "
                                      "other programs misread the map. {}",
                                      wrong, kRepair)});
}

void check_registration(Connection& map, std::vector<MapProblem>& problems) {
  // 9e999 is infinite, and a text is more than any number.
  Statement wrong(map,
                  "SELECT name, registration_sigma_m FROM roadfix_sources WHERE (registration_sigma_m > 0 AND "
                  "registration_sigma_m < 9e999) IS NOT 1 ORDER BY name");
  while (wrong.step()) {
    problems.push_back(
        {"registration-wrong",
         fmt::format("source '{}' states a registration error of {} m, by which positions would count as surer or less "
                     "sure than they are. Ingest it again with --replace, or restore the map from a copy",
                     wrong.text(0), wrong.text(1))});
  }
}

void check_shifts(Connection& map, std::vector<MapProblem>& problems) {
  for (const auto& [name, shift] : read_shifts(map)) {
    if (shift.sigma_m > 0.0 && std::isfinite(shift.sigma_m)) continue;
    problems.push_back(
        {"registration-wrong",
         fmt::format("source '{}' is said to lie beside the others by an impossible distance (it counts with a "
                     "registration error of {} m). Ingest it again, which measures that anew",
                     name, shift.sigma_m)});
  }
}

}  // namespace

std::vector<MapProblem> problems_of_description(Connection& map, const MapSettings& settings) {
  std::vector<MapProblem> problems;
  check_lattice(map, settings, problems);
  check_reference(map, settings, problems);
  check_coverage(map, problems);
  check_tile_scales(map, problems);
  check_registration(map, problems);
  check_shifts(map, problems);
  return problems;
}

}  // namespace roadfix
