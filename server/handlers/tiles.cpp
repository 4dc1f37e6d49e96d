#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "server/api/fields.hpp"
#include "server/api/tile_address.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"
#include "server/handlers/tile_answers.hpp"
#include "tiles/mercator/tile_picture.hpp"

namespace roadfix::server {
namespace {

using nlohmann::json;

constexpr int kZoomsBeyondNative = 3;

http::Response get_tile(const Service& service, const http::Request& request) {
  const auto& at = request.path_parameters;
  const mercator::TileAddress tile = api::parse_tile(at.at("z"), at.at("x"), at.at("y"));
  const mercator::TileStyle style = api::Fields(request.query).choice("style", kTileStyles);
  const auto map = service.maps.find(at.at("map"));
  return tile_response(request, entity_tag(map->edition(), fmt::format("{}{}", to_string(style), request.path)), [&] {
    const std::string key =
        fmt::format("{}/{}/{}/{}/{}/{}", map->name(), map->edition(), to_string(style), tile.z, tile.x, tile.y);
    return kept_or_drawn(service.pictures, key, [&] { return mercator::tile_png(map->view, tile, style); });
  });
}

http::Response get_tilejson(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  const mercator::TileStyle style = api::Fields(request.query).choice("style", kTileStyles);
  json answer = tilejson(request, *map, map->name(), style_query(style));
  answer.update({{"minzoom", 0}, {"maxzoom", mercator::kMaxZoom}});
  const MapView& view = map->view;
  if (!view.extent.empty()) {
    const int native = mercator::native_zoom(view);
    const LatLon centre = view.zone.unproject(view.extent.centre());
    answer["center"] = {centre.lon_deg, centre.lat_deg, std::max(0, native - kZoomsBeyondNative)};
    answer["maxzoom"] = std::min(mercator::kMaxZoom, native + kZoomsBeyondNative);
  }
  return tilejson_response(answer);
}

}  // namespace

void add_tile_routes(Routes& routes) {
  routes.add("GET", "/v1/maps/{map}/tiles/{z}/{x}/{y}.png", {"style", "version"}, get_tile);
  routes.add("GET", "/v1/maps/{map}/tilejson.json", {"style"}, get_tilejson);
}

}  // namespace roadfix::server
