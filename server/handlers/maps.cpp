#include <algorithm>

#include "core/units/error.hpp"
#include "server/api/map_json.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

using nlohmann::json;

json named(const ServedMap& map, json answer) {
  answer["name"] = map.name();
  return answer;
}

json unreadable(const UnreadableMap& map) {
  return {{"name", map.name}, {"status", "unreadable"}, {"code", map.code}, {"reason", map.reason}};
}

http::Response list(const Service& service, const http::Request& /*unused*/) {
  std::vector<json> maps;
  for (const auto& map : service.maps.maps()) {
    try {
      maps.push_back(named(*map, api::summary_json(map->reader->info())));
    } catch (const Error& error) {  // of one map; the others are still to be listed
      maps.push_back(unreadable({map->name(), error.code(), error.what()}));
    }
  }
  for (const UnreadableMap& map : service.maps.unreadable()) maps.push_back(unreadable(map));
  std::ranges::sort(maps, {}, [](const json& map) { return map["name"].get<std::string>(); });
  return json_response({{"maps", maps}});
}

http::Response details(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  return json_response(named(*map, api::to_json(map->reader->info())));
}

}  // namespace

void add_map_routes(Routes& routes) {
  routes.add("GET", "/v1/maps", {}, list);
  routes.add("GET", "/v1/maps/{map}", {}, details);
}

}  // namespace roadfix::server
