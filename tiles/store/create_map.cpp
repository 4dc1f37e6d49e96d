#include "tiles/store/create_map.hpp"

#include <fmt/format.h>

#include <string>

#include "core/grid/lattice.hpp"
#include "core/units/error.hpp"
#include "core/units/file_beside.hpp"
#include "schema/schema.hpp"
#include "tiles/store/map_error.hpp"
#include "tiles/store/map_file.hpp"
#include "tiles/store/tile_matrix.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;
using sqlite::Access;
using sqlite::Connection;
using sqlite::Statement;
using sqlite::Transaction;

void insert_settings(Connection& map, const MapSettings& settings) {
  const int epsg = settings.zone.epsg();
  Statement(map, "INSERT INTO gpkg_spatial_ref_sys VALUES (?1, ?2, 'EPSG', ?2, ?3, NULL)")
      .with(fmt::format("WGS 84 / UTM zone {}{}", settings.zone.number(), settings.zone.northern() ? 'N' : 'S'), epsg,
            wkt_of(settings.zone))
      .run();
  Statement(map,
            "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, srs_id) VALUES "
            "('road_probability', '2d-gridded-coverage', 'road_probability', 'Probability of road', ?1)")
      .with(epsg)
      .run();
  Statement(map, "INSERT INTO gpkg_tile_matrix_set VALUES ('road_probability', ?1, 0, 0, ?2, ?3)")
      .with(epsg, kLattice.max.east_m, kLattice.max.north_m)
      .run();
  Statement level(map, "INSERT INTO gpkg_tile_matrix VALUES ('road_probability', ?1, ?2, ?3, ?4, ?4, ?5, ?5)");
  for (int zoom = kCoarsestZoom; zoom <= zoom_of(settings.cell_m); ++zoom) {
    level.with(zoom, matrix_width(zoom), matrix_height(zoom), kTileCells, cell_of_zoom(zoom)).run();
  }
  Statement(map,
            "INSERT INTO gpkg_2d_gridded_coverage_ancillary (tile_matrix_set_name, datatype, scale, precision, "
            "data_null, grid_cell_encoding, field_name, quantity_definition) VALUES ('road_probability', 'integer', "
            "1.0 / 254, 1.0 / 254, 65535, 'grid-value-is-area', 'Probability', 'Probability of road')")
      .run();
  Statement meta(map, "INSERT INTO roadfix_meta VALUES (?1, ?2)");
  meta.with("schema_version", std::to_string(kSchemaVersion)).run();
  meta.with("epsg", std::to_string(epsg)).run();
  meta.with("cell_m", fmt::format("{}", settings.cell_m)).run();
  meta.with("version", version_text(0)).run();
}

void write_map(const fs::path& path, const MapSettings& settings) {
  Connection map(path, Access::kCreate, map_error);
  Transaction transaction(map, Transaction::Kind::kWrite);
  map.execute(std::string(schema::map_sql()).c_str());
  insert_settings(map, settings);
  transaction.commit();
}

}  // namespace

std::string wkt_of(const UtmZone& zone) {
  return fmt::format(
      R"(PROJCS["WGS 84 / UTM zone {}{}",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,)"
      R"(AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],)"
      R"(UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]],)"
      R"(PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",{}],)"
      R"(PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",{}],)"
      R"(UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AXIS["Northing",NORTH],)"
      R"(AUTHORITY["EPSG","{}"]])",
      zone.number(), zone.northern() ? 'N' : 'S', 6 * zone.number() - 183, zone.northern() ? 0 : 10'000'000,
      zone.epsg());
}

void create_map(const fs::path& path, const MapSettings& settings) {
  if (!is_map_cell_size(settings.cell_m)) {
    throw InvalidInput("cell-size-not-supported",
                       fmt::format("cells of {} m: a map has cells of 0.25, 0.5, 1, 2, 4, 8 or 16 m", settings.cell_m));
  }
  FileBeside map(path, path.string() + "-new");
  sqlite::remove_logs(map.unfinished());
  try {
    write_map(map.unfinished(), settings);
    sqlite::remove_logs(path);  // of a map that was deleted without them
    map.finish();
  } catch (const fs::filesystem_error& error) {
    throw IoFailure("map-not-writable", fmt::format("{}: {}", path.string(), error.code().message()));
  } catch (...) {
    sqlite::remove_logs(map.unfinished());
    throw;
  }
}

}  // namespace roadfix
