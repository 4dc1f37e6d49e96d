#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.hpp"
#include "cli/shift_text.hpp"
#include "cli/terrain_text.hpp"
#include "core/geodesy/geo_box.hpp"
#include "core/units/json_text.hpp"
#include "server/api/map_json.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix::cli {
namespace {

using nlohmann::json;

struct InfoArguments {
  std::string map;
  bool as_json = false;
};

/// With what a service does not tell everyone.
void print_json(const std::string& path, const MapInfo& info) {
  json answer = api::to_json(info);
  answer["map"] = path;
  answer["pending_tiles"] = info.pending;
  answer["schema_version"] = info.schema_version;
  if (info.terrain) answer["terrain"]["location"] = info.terrain->record.location;
  for (std::size_t i = 0; i < info.sources.size(); ++i) {
    const SourceStatus& source = info.sources[i];
    answer["sources"][i].update({{"location", source.record.location},
                                 {"fingerprint", source.record.fingerprint},
                                 {"ingested_at", source.ingested_at}});
  }
  fmt::print("{}\n", json_text(answer, 2));
}

void print_extent(const MapInfo& info) {
  if (info.extent.empty()) {
    fmt::print("extent    nothing observed yet\n");
    return;
  }
  const auto [sw, ne] = geo_box_around(info.settings.zone, info.extent);
  fmt::print("extent    {:.1f} x {:.1f} km, latitude {:.6f} to {:.6f}, longitude {:.6f} to {:.6f}\n",
             info.extent.width_m() / 1000.0, info.extent.height_m() / 1000.0, sw.lat_deg, ne.lat_deg, sw.lon_deg,
             ne.lon_deg);
}

std::string state_of(const SourceStatus& source) {
  if (!source.complete) {
    return fmt::format("incomplete: {} of {} blocks. Repeat the ingest to go on", source.blocks_done,
                       source.blocks_total);
  }
  if (source.is_damaged()) {
    return fmt::format("damaged: {} of {} blocks are lost. Ingest it again with --replace",
                       source.blocks_total - source.blocks_done, source.blocks_total);
  }
  return fmt::format("ingested {}", source.ingested_at);
}

void print_told(const Provenance& told) {
  for (const auto& [label, value] :
       {std::pair{"date", told.date}, std::pair{"licence", told.licence}, std::pair{"attribution", told.attribution}}) {
    if (!value.empty()) fmt::print("  {:<13} {}\n", label, value);
  }
}

void print_terrain(const TerrainStatus& terrain) {
  fmt::print("\nterrain   {}\n  added         {}\n  location      {}\n", heights_text(terrain), terrain.added_at,
             terrain.record.location);
  print_told(terrain.record.provenance);
}

void print_source(const SourceStatus& source) {
  const SourceRecord& r = source.record;
  const std::string state = state_of(source);
  fmt::print("\nsource    {} ({})\n  state         {}\n  location      {}\n  made by       {}\n", r.name,
             to_string(r.content), state, r.location, r.method);
  print_told(r.provenance);
  fmt::print("  position      {:.3g} m (1 sigma)\n", source.registration_sigma_m());
  if (source.shift) {
    fmt::print("                not the {:.3g} m stated: it would fit the other sources better {}\n",
               r.provenance.registration_sigma_m, directions_of(*source.shift));
  }
}

void print_text(const std::string& path, const MapInfo& info) {
  fmt::print("map       {}\n", path);
  fmt::print("grid      EPSG:{}, cells of {} m, {} levels\n", info.settings.zone.epsg(), info.settings.cell_m,
             info.levels);
  print_extent(info);
  fmt::print("tiles     {} of {} x {} cells, version {}\n", info.tiles, kTileCells, kTileCells, info.version);
  if (info.pending > 0) {
    fmt::print("          {} tiles wait to be fused: an ingest was interrupted. Repeat it\n", info.pending);
  }
  for (const SourceStatus& source : info.sources) print_source(source);
  if (info.terrain) print_terrain(*info.terrain);
}

}  // namespace

void add_info_command(CLI::App& app) {
  auto* command = app.add_subcommand("info", "Shows what a map holds and where it came from");
  command->footer("Example: roadfix info adiyaman.gpkg --json");
  const auto options = std::make_shared<InfoArguments>();
  command->add_option("map", options->map, "Map file (GeoPackage)")->required();
  command->add_flag("--json", options->as_json, "Answer in JSON");
  command->callback([options] {
    const MapReader reader(options->map);
    options->as_json ? print_json(options->map, reader.info()) : print_text(options->map, reader.info());
  });
}

}  // namespace roadfix::cli
