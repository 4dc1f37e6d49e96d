#include <fmt/format.h>

#include <array>

#include "core/detect/feature_map_codec.hpp"
#include "core/png/png_text.hpp"
#include "server/api/json_parts.hpp"
#include "server/api/media.hpp"
#include "server/api/window.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"
#include "server/http/admission.hpp"
#include "tiles/export/window_tiff.hpp"

namespace roadfix::server {
namespace {

constexpr std::array<api::Media, 3> kWindowFormats{
    {{"png", "image/png"}, {"tiff", "image/tiff"}, {"json", "application/json"}}};

http::Response rendered(const api::Window& window, const MapInfo& info, std::string_view format) {
  const std::string credits = credits_of(info);
  if (format == "json") {
    auto answer = api::to_json(window);
    answer["attribution"] = credits;
    return json_response(answer);
  }
  if (format == "tiff") {
    return {200, "image/tiff", window_tiff(window.cells.cells, window.zone, api::geotransform(window), info)};
  }
  auto png = encode_feature_map(window.cells);
  if (!credits.empty()) png = with_utf8_text(png, "Copyright", credits);
  return {200, "image/png", std::string(png.begin(), png.end())};
}

http::Response get_window(const Service& service, const http::Request& request, http::Admission& turns) {
  const api::Fields fields(request.query);
  const api::WindowRequest asked = api::parse_window(fields);
  const std::string_view format = api::media_asked_for(request, fields, kWindowFormats).name;
  const auto map = service.maps.find(request.path_parameters.at("map"));
  const http::Admission::Ticket turn = turns.enter(request.client, request.deadline, request.abandoned);
  const api::Window window = api::cut_window(map->view, asked, service.limits);
  http::Response response = rendered(window, map->reader->info(), format);
  // What a picture cannot say about itself, so that it can be posted back: its pose and cell size.
  response.headers.emplace_back("Roadfix-Pose", api::pose_json(window.pose).dump());
  response.headers.emplace_back("Roadfix-Cell-M", fmt::format("{}", window.cells.cell_m));
  response.headers.emplace_back("Vary", "Accept");
  response.headers.emplace_back("Cache-Control", "no-cache");
  return response;
}

}  // namespace

void add_window_route(Routes& routes) {
  // The map around a long window on a slant takes hundreds of megabytes.
  routes.add(
      "GET", "/v1/maps/{map}/window", api::window_fields(),
      [turns = turns_of(routes.service())](const Service& service, const http::Request& request) {
        return get_window(service, request, *turns);
      },
      http::Load::kLong);
}

}  // namespace roadfix::server
