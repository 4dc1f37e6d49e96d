#include "core/locate/match_poses.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/flight_request.hpp"
#include "server/api/time_limit.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

/// The heading step lets many poses share rotations of the feature map.
std::vector<std::string> match_fields() { return joined({api::feature_fields(), {"heading_step_deg"}}); }

http::Response post_match(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  const api::Content content =
      api::read_content(request, joined({match_fields(), {"poses"}, api::flight_members()}), service.limits);
  const std::vector<GeoPose> poses = api::parse_poses(content.fields, service.limits);
  MatchOptions options;
  options.heading_step = content.fields.optional_angle("heading_step_deg", {0.0, 90.0}).value_or(Angle());
  const api::TimeLimit limit(request.deadline, request.abandoned);
  const auto detector = service.detectors.for_map(map->view.imagery_reader);
  const api::Features features =
      api::flight_features_of(content, {*detector, map->view.cell_m, limit.token()}, service.limits);
  options.stop = limit.token();
  const SearchThreads::Share share(service.search_threads);
  options.threads = share.threads();
  return json_response(api::to_json(match(map->view, features.map, poses, options), map->view, features));
}

}  // namespace

void add_match_route(Routes& routes) {
  routes.add("POST", "/v1/maps/{map}/match", match_fields(), post_match, http::Load::kHeavy);
}

}  // namespace roadfix::server
