#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/date_check.hpp"
#include "cli/terminal.hpp"
#include "cli/terrain_text.hpp"
#include "core/units/error.hpp"
#include "core/units/json_text.hpp"
#include "server/api/map_json.hpp"
#include "tiles/imagery/elevation_models.hpp"
#include "tiles/store/map_reader.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix::cli {
namespace {

using nlohmann::json;

struct TerrainArguments {
  std::string map;
  std::vector<std::string> models;
  Provenance told;
  bool remove = false;
  bool as_json = false;
};

ElevationReading read_with_progress(const TerrainArguments& arguments, const MapWriter& writer) {
  if (writer.extent().empty()) {
    throw InvalidInput("map-has-no-cells",
                       fmt::format("{}: the map holds no ground yet of which there could be heights. Ingest a source "
                                   "first",
                                   arguments.map));
  }
  Progress progress("terrain", "tiles");
  return read_elevation_models(arguments.models, writer.settings().zone,
                               terrain_geometry(writer.extent(), kMostTerrainCells), progress.updates(),
                               stop_on_signals());
}

std::vector<std::string> notes_on(const ElevationReading& reading, const TerrainStatus& terrain) {
  std::vector<std::string> notes;
  for (const std::string& model : reading.beside) {
    notes.push_back(fmt::format("{} knows no height of the map's ground or around it", model));
  }
  if (terrain.known_share < 1.0) {
    notes.push_back(
        fmt::format("on {:.3g} % of the map no height is known: there a vehicle's height above ground cannot follow "
                    "from that above the sea. Name further elevation models beside these to fill it",
                    100.0 * (1.0 - terrain.known_share)));
  }
  return notes;
}

void write(const TerrainArguments& arguments, MapWriter& writer) {
  const ElevationReading reading = read_with_progress(arguments, writer);
  writer.put_terrain(reading.terrain, {fmt::format("{}", fmt::join(arguments.models, ", ")), arguments.told});
  const TerrainStatus terrain = info_of(arguments.map).value().terrain.value();
  const std::vector<std::string> notes = notes_on(reading, terrain);
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
  if (!arguments.as_json) {
    fmt::print("{}: terrain in {}\n", arguments.map, heights_text(terrain));
    return;
  }
  json answer{{"map", arguments.map}, {"terrain", api::to_json(terrain)}};
  if (!notes.empty()) answer["notes"] = notes;
  fmt::print("{}\n", json_text(answer));
}

void remove(const TerrainArguments& arguments, MapWriter& writer) {
  if (!writer.remove_terrain()) {
    throw NotFound("terrain-not-found", fmt::format("{}: the map has no terrain", arguments.map));
  }
  if (arguments.as_json) {
    fmt::print("{}\n", json_text(json{{"map", arguments.map}, {"terrain", nullptr}}));
  } else {
    fmt::print("{}: its terrain is removed\n", arguments.map);
  }
}

void run(const TerrainArguments& arguments) {
  MapWriter writer = MapWriter::existing(arguments.map);
  arguments.remove ? remove(arguments, writer) : write(arguments, writer);
}

}  // namespace

void add_terrain_command(CLI::App& app) {
  const auto a = std::make_shared<TerrainArguments>();
  CLI::App* command = app.add_subcommand(
      "terrain",
      "Gives a map the heights of its ground, by which a vehicle that knows its height above the sea is located");
  command->footer(
      "Examples:\n"
      "  roadfix terrain city.gpkg Copernicus_DSM_COG_10_N37_00_E038_00_DEM.tif --date 2021 --licence \"Copernicus DEM "
      "licence\" --attribution \"produced using Copernicus WorldDEM-30 (c) DLR e.V. 2010-2014 and (c) Airbus Defence "
      "and Space GmbH 2014-2018 provided under COPERNICUS by the European Union and ESA; all rights reserved\"\n"
      "  roadfix terrain city.gpkg N37E038.hgt N37E039.hgt --licence \"public domain\" --attribution \"SRTM, "
      "NASA/USGS\"\n"
      "  roadfix terrain city.gpkg --remove\n"
      "Heights are above the sea, in metres or feet, as the file says; where it says nothing, in metres, unless its "
      "coordinates are in feet: then it has to say so. They are kept in cells of 32 m, of 64 m and "
      "more for maps of more than 130 x 130 km, for the map's ground and 2 km around it. A map that has grown needs "
      "them anew; those that it had are replaced. If it is interrupted, the map is as it was.");
  command->add_option("map", a->map, "Map file (GeoPackage)")->required();
  auto* models = command->add_option(
      "DEM", a->models,
      "Elevation models that GDAL reads (GeoTIFF, .hgt, VRT); the finest counts where several overlap");
  auto* remove = command->add_flag("--remove", a->remove, "Take the heights out of the map")->excludes(models);
  command->add_option("--date", a->told.date, "Date of the heights, ISO 8601: 2021 or 2021-06")
      ->check(iso_date())
      ->excludes(remove);
  command->add_option("--licence", a->told.licence, "Licence of the elevation models")->excludes(remove);
  command->add_option("--attribution", a->told.attribution, "Attribution that the licence asks for")->excludes(remove);
  command->add_flag("--json", a->as_json, "Answer in JSON");
  command->callback([a] {
    if (a->models.empty() && !a->remove) throw CLI::RequiredError("DEM (or --remove)");
    run(*a);
  });
}

}  // namespace roadfix::cli
