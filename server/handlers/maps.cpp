#include <algorithm>

#include "core/geodesy/geo_box.hpp"
#include "core/units/error.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/source_json.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

using nlohmann::json;

const char* status_of(const MapInfo& info) {
  if (std::ranges::any_of(info.sources, &SourceStatus::is_damaged)) return "damaged";
  if (info.extent.empty()) return "empty";
  return info.pending > 0 ? "incomplete" : "ready";
}

json summary(const ServedMap& map) {
  const MapInfo& info = map.reader->info();
  json answer{{"name", map.name},
              {"status", status_of(info)},
              {"version", info.version},
              {"epsg", info.settings.zone.epsg()},
              {"cell_m", info.settings.cell_m},
              {"levels", info.levels},
              {"bbox", nullptr},
              {"area_km2", 0.0}};
  if (info.extent.empty()) return answer;
  answer["bbox"] = api::bbox_json(geo_box_around(info.settings.zone, info.extent));
  answer["area_km2"] = info.extent.width_m() * info.extent.height_m() / 1e6;
  return answer;
}

json details(const ServedMap& map) {
  const MapInfo& info = map.reader->info();
  json answer = summary(map);
  answer["tiles"] = info.tiles;
  answer["extent_m"] = nullptr;
  if (!info.extent.empty()) {
    answer["extent_m"] = {info.extent.min.east_m, info.extent.min.north_m, info.extent.max.east_m,
                          info.extent.max.north_m};
  }
  answer["sources"] = json::array();
  for (const SourceStatus& source : info.sources) answer["sources"].push_back(api::to_json(source));
  return answer;
}

json unreadable(const UnreadableMap& map) {
  return {{"name", map.name}, {"status", "unreadable"}, {"code", map.code}, {"reason", map.reason}};
}

http::Response list(const Service& service) {
  std::vector<json> maps;
  for (const auto& map : service.maps.maps()) {
    try {
      maps.push_back(summary(*map));
    } catch (const Error& error) {  // of one map; the others are still to be listed
      maps.push_back(unreadable({map->name, error.code(), error.what()}));
    }
  }
  for (const UnreadableMap& map : service.maps.unreadable()) maps.push_back(unreadable(map));
  std::ranges::sort(maps, {}, [](const json& map) { return map["name"].get<std::string>(); });
  return json_response({{"maps", maps}});
}

}  // namespace

void add_map_routes(http::Router& router, const Service& service) {
  router.add({"GET", "/v1/maps", {}, http::Load::kLight, [&service](const http::Request&) { return list(service); }});
  router.add({"GET", "/v1/maps/{map}", {}, http::Load::kLight, [&service](const http::Request& request) {
                return json_response(details(*service.maps.find(request.path_parameters.at("map"))));
              }});
}

}  // namespace roadfix::server
