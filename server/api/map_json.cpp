#include "server/api/map_json.hpp"

#include <algorithm>

#include "core/geodesy/geo_box.hpp"
#include "server/api/json_parts.hpp"
#include "server/api/source_json.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

const char* status_text(const MapInfo& info) {
  if (std::ranges::any_of(info.sources, &SourceStatus::is_damaged)) return "damaged";
  if (info.extent.empty()) return "empty";
  return info.pending > 0 || !missing_of(info).empty() ? "incomplete" : "ready";
}

}  // namespace

json summary_json(const MapInfo& info) {
  json answer{{"status", status_text(info)},
              {"version", info.version},
              {"epsg", info.settings.zone.epsg()},
              {"cell_m", info.settings.cell_m},
              {"levels", info.levels},
              {"bbox", nullptr},
              {"area_km2", 0.0}};
  if (info.terrain) answer["terrain"] = to_json(*info.terrain);
  if (info.extent.empty()) return answer;
  answer["bbox"] = bbox_json(geo_box_around(info.settings.zone, info.extent));
  answer["area_km2"] = info.extent.width_m() * info.extent.height_m() / 1e6;
  return answer;
}

json to_json(const TerrainStatus& terrain) {
  const Provenance& p = terrain.record.provenance;
  return {{"cell_m", terrain.terrain->geometry.cell_m},
          {"lowest_m", terrain.heights.lowest_m},
          {"highest_m", terrain.heights.highest_m},
          {"known_share", terrain.known_share},
          {"date", p.date},
          {"licence", p.licence},
          {"attribution", p.attribution},
          {"added_at", terrain.added_at}};
}

json to_json(const MapInfo& info) {
  json answer = summary_json(info);
  answer["tiles"] = info.tiles;
  answer["extent_m"] = nullptr;
  if (!info.extent.empty()) {
    answer["extent_m"] = {info.extent.min.east_m, info.extent.min.north_m, info.extent.max.east_m,
                          info.extent.max.north_m};
  }
  answer["sources"] = json::array();
  for (const SourceStatus& source : info.sources) answer["sources"].push_back(to_json(source));
  return answer;
}

}  // namespace roadfix::api
