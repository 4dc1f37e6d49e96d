#include "server/handlers/tile_answers.hpp"

#include <fmt/format.h>

#include "server/api/json_parts.hpp"
#include "server/handlers/answers.hpp"
#include "tiles/mercator/tile_ground.hpp"

namespace roadfix::server {
namespace {

/// Not longer, though their addresses change with the map: a page that stays open asks for the same ones again, and
/// gets what is there by then.
constexpr const char* kCacheControl = "public, max-age=60";

}  // namespace

std::string style_query(mercator::TileStyle style) {
  return style == kTileStyles.front().value ? "" : fmt::format("&style={}", to_string(style));
}

std::string kept_or_drawn(PictureCache& pictures, const std::string& key, const DrawTile& draw) {
  if (auto kept = pictures.find(key)) return *std::move(kept);
  const auto png = draw();
  std::string bytes = png ? std::string(reinterpret_cast<const char*>(png->data()), png->size()) : std::string();
  pictures.insert(key, bytes);
  return bytes;
}

http::Response tile_response(const http::Request& request, const std::string& tag,
                             const std::function<std::string()>& picture) {
  http::Response response{304, {}, {}, {{"ETag", tag}, {"Cache-Control", kCacheControl}}};
  if (is_known_to_client(request, tag)) return response;
  response.body = picture();
  response.status = response.body.empty() ? 204 : 200;
  if (response.status == 200) response.content_type = "image/png";
  return response;
}

nlohmann::json tilejson(const http::Request& request, const ServedMap& map, const std::string& name,
                        const std::string& query) {
  const std::string folder = base_url(request) + request.path.substr(0, request.path.rfind('/'));
  nlohmann::json answer{
      {"tilejson", "3.0.0"},
      {"name", name},
      {"version", "1.0.0"},
      {"scheme", "xyz"},
      {"attribution", credits_of(map.reader->info())},
      {"tiles", {fmt::format("{}/tiles/{{z}}/{{x}}/{{y}}.png?version={}{}", folder, map.edition(), query)}}};
  const MapView& view = map.view;
  if (!view.extent.empty()) answer["bounds"] = api::bbox_json(mercator::bounds_of(view));
  return answer;
}

http::Response tilejson_response(const nlohmann::json& tilejson) {
  http::Response response = json_response(tilejson);
  // Kept for a minute it would lead to tiles of the map before, which are kept too.
  response.headers.emplace_back("Cache-Control", "no-cache");
  return response;
}

}  // namespace roadfix::server
