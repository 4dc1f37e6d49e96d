#include "server/api/feature_request.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/flight_request.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

std::vector<std::string> query_fields() { return joined(api::feature_fields(), api::prior_fields()); }

http::Response post_fix(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  const api::Content content =
      api::read_content(request, joined(query_fields(), api::picture_members()), service.limits);
  const Prior prior = api::parse_prior(content.fields);
  FixOptions options = api::parse_fix_options(content.fields, service.limits);
  const api::Features features = api::flight_features_of(content, service.detector, map->view.cell_m, service.limits);
  options.calibration = service.calibration;
  options.threads = service.search_threads;
  api::shorten(options, request.deadline);
  return json_response(api::to_json(locate(map->view, features.map, prior, options), features.detect_time));
}

}  // namespace

void add_fix_route(http::Router& router, const Service& service) {
  router.add({"POST", "/v1/maps/{map}/fix", query_fields(), true,
              [&service](const http::Request& request) { return post_fix(service, request); }});
}

}  // namespace roadfix::server
