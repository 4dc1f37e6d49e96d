#include <fmt/format.h>

#include <array>

#include "core/geodesy/geo_box.hpp"
#include "server/api/fields.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/tile_picture.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 2> kStyles{"colour", "grey"};
constexpr const char* kCacheControl = "public, max-age=60";
constexpr int kZoomsBeyondNative = 3;

std::string rendered(const Service& service, const ServedMap& map, api::TileAddress tile, const std::string& style) {
  const std::string key = fmt::format("{}/{}/{}/{}/{}/{}", map.name, map.view.version, style, tile.z, tile.x, tile.y);
  if (auto kept = service.pictures.find(key)) return *kept;
  const auto png = api::tile_png(map.view, tile, style == "grey" ? api::TileStyle::kGrey : api::TileStyle::kColour);
  std::string bytes = png ? std::string(png->begin(), png->end()) : std::string();
  service.pictures.keep(key, bytes);
  return bytes;
}

http::Response get_tile(const Service& service, const http::Request& request) {
  const auto& at = request.path_parameters;
  const api::TileAddress tile = api::parse_tile(at.at("z"), at.at("x"), at.at("y"));
  const std::string style = api::Fields(request.query).word("style", kStyles);
  const auto map = service.maps.find(at.at("map"));
  const std::string tag = entity_tag(map->view.version, style + request.path);
  http::Response response{304, {}, {}, {{"ETag", tag}, {"Cache-Control", kCacheControl}}};
  if (is_known_to_client(request, tag)) return response;
  response.body = rendered(service, *map, tile, style);
  response.status = response.body.empty() ? 204 : 200;
  if (response.status == 200) response.content_type = "image/png";
  return response;
}

std::string attribution(const MapInfo& info) {
  std::string text;
  for (const SourceStatus& source : info.sources) {
    const std::string& name = source.record.attribution;
    if (source.complete && !name.empty() && text.find(name) == std::string::npos)
      text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

http::Response get_tilejson(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  const MapInfo& info = map->reader->info();
  const std::string style = api::Fields(request.query).word("style", kStyles);
  const std::string url = base_url(request) + request.path.substr(0, request.path.rfind('/')) +
                          "/tiles/{z}/{x}/{y}.png" + (style == kStyles[0] ? "" : "?style=" + style);
  json answer{{"tilejson", "3.0.0"}, {"name", map->name},       {"version", "1.0.0"},
              {"scheme", "xyz"},     {"tiles", {url}},          {"attribution", attribution(info)},
              {"minzoom", 0},        {"maxzoom", api::kMaxZoom}};
  if (!info.extent.empty()) {
    const GeoBox b = geo_box_around(info.settings.zone, info.extent);
    const int native = api::native_zoom(map->view);
    answer["bounds"] = api::bbox_json(b);
    answer["center"] = {0.5 * (b.south_west.lon_deg + b.north_east.lon_deg),
                        0.5 * (b.south_west.lat_deg + b.north_east.lat_deg), std::max(0, native - kZoomsBeyondNative)};
    answer["maxzoom"] = std::min(api::kMaxZoom, native + kZoomsBeyondNative);
  }
  http::Response response = json_response(answer);
  response.headers.emplace_back("Cache-Control", kCacheControl);
  return response;
}

}  // namespace

void add_tile_routes(http::Router& router, const Service& service) {
  router.add({"GET",
              "/v1/maps/{map}/tiles/{z}/{x}/{y}.png",
              {"style"},
              http::Load::kLight,
              [&service](const http::Request& request) { return get_tile(service, request); }});
  router.add(
      {"GET", "/v1/maps/{map}/tilejson.json", {"style"}, http::Load::kLight, [&service](const http::Request& request) {
         return get_tilejson(service, request);
       }});
}

}  // namespace roadfix::server
