#include "server/handlers/tile_answers.hpp"

#include "server/handlers/answers.hpp"

namespace roadfix::server {
namespace {

constexpr const char* kCacheControl = "public, max-age=60";

}  // namespace

api::TileStyle tile_style(std::string_view word) {
  return word == "grey" ? api::TileStyle::kGrey : api::TileStyle::kColour;
}

std::string kept_or_drawn(PictureCache& pictures, const std::string& key, const DrawTile& draw) {
  if (auto kept = pictures.find(key)) return *std::move(kept);
  const auto png = draw();
  std::string bytes = png ? std::string(png->begin(), png->end()) : std::string();
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

nlohmann::json tilejson(const http::Request& request, const std::string& name, const std::string& query) {
  const std::string folder = base_url(request) + request.path.substr(0, request.path.rfind('/'));
  return {{"tilejson", "3.0.0"},
          {"name", name},
          {"version", "1.0.0"},
          {"scheme", "xyz"},
          {"tiles", {folder + "/tiles/{z}/{x}/{y}.png" + query}}};
}

http::Response tilejson_response(const nlohmann::json& tilejson) {
  http::Response response = json_response(tilejson);
  response.headers.emplace_back("Cache-Control", kCacheControl);
  return response;
}

}  // namespace roadfix::server
