#include <fmt/format.h>

#include <array>

#include "core/detect/feature_map_codec.hpp"
#include "server/api/base64.hpp"
#include "server/api/feature_json.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/media.hpp"
#include "server/api/time_limit.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

constexpr double kDefaultCellM = 2.0;
constexpr std::array<api::Media, 2> kDetectFormats{{{"png", "image/png"}, {"json", "application/json"}}};

std::vector<std::string> detect_fields() { return joined({api::frame_fields(), {"compare_with", "format"}}); }

http::Response post_detect(const Service& service, const http::Request& request) {
  const api::Content content = api::read_content(request, joined({detect_fields(), {"image"}}), service.limits);
  const std::string_view format = api::media_asked_for(request, content.fields, kDetectFormats).name;
  const api::TimeLimit limit(request.deadline, request.abandoned);
  const auto detector = service.detectors.compared_with(content.fields.choice("compare_with", kSourceContents));
  const api::Features features = api::detected(content, {*detector, kDefaultCellM, limit.token()}, service.limits);
  http::Response response;
  if (format == "json") {
    nlohmann::json answer = api::detection_json(features);
    answer["cells"] = api::base64_encoded(features.map.cells.cells());
    response = json_response(answer);
  } else {
    const auto png = encode_feature_map(features.map, detector->describe());
    response = {200, "image/png", std::string(png.begin(), png.end())};
  }
  const auto& [col, row] = features.map.nadir;
  response.headers.emplace_back("Roadfix-Cell-M", fmt::format("{}", features.map.cell_m));
  response.headers.emplace_back("Roadfix-Nadir", fmt::format("{},{}", col, row));
  response.headers.emplace_back("Roadfix-Nadir-Sigma-M", fmt::format("{}", features.map.nadir_sigma_m));
  response.headers.emplace_back("Roadfix-Nadir-Heading-Sigma-Deg",
                                fmt::format("{}", features.map.nadir_heading_sigma.degrees()));
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

}  // namespace

void add_detect_route(Routes& routes) {
  routes.add("POST", "/v1/detect", detect_fields(), post_detect, http::Load::kHeavy);
}

}  // namespace roadfix::server
