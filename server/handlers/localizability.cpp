#include "core/locate/localizability.hpp"

#include "server/api/fields.hpp"
#include "server/api/fix_json.hpp"
#include "server/api/fix_request.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

std::vector<std::string> query_fields() { return {"lat", "lon", "footprint_m", "radius_m"}; }

http::Response get_localizability(const Service& service, const http::Request& request) {
  const auto map = service.maps.find(request.path_parameters.at("map"));
  const api::Fields fields(request.query);
  LocalizabilityQuery query;
  query.position = {fields.number("lat", api::kLatitude), fields.number("lon", api::kLongitude)};
  query.footprint_m = fields.number("footprint_m", {20.0, 5000.0});
  query.radius_m = fields.optional_number("radius_m", {0.0, 20'000.0, true}).value_or(query.radius_m);
  query.fix.max_search_km2 = service.limits.search_km2;
  query.fix.calibration = service.calibration;
  query.fix.threads = service.search_threads;
  api::shorten(query.fix, request.deadline);
  nlohmann::json answer = api::to_json(localizability(map->view, query));
  answer["map"] = {{"name", map->name}, {"version", map->view.version}};
  return json_response(answer);
}

}  // namespace

void add_localizability_route(http::Router& router, const Service& service) {
  router.add({"GET", "/v1/maps/{map}/localizability", query_fields(), true,
              [&service](const http::Request& request) { return get_localizability(service, request); }});
}

}  // namespace roadfix::server
