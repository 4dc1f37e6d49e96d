#include "schema/schema.hpp"
#include "server/api/json_body.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

using nlohmann::json;

http::Response health(const Service& /*unused*/, const http::Request& /*unused*/) {
  return json_response({{"status", "ok"}, {"version", ROADFIX_VERSION}});
}

http::Response ready(const Service& service, const http::Request& /*unused*/) {
  const auto maps = service.maps.maps().size();
  json answer{{"status", "ready"}, {"maps", maps}, {"unreadable_maps", service.maps.unreadable().size()}};
  // Maps are served all the same, so that neither is a reason to send requests elsewhere.
  if (const auto problem = service.maps.problem()) answer["maps_problem"] = *problem;
  const auto problem = service.tracks.problem();
  answer["tracks"] = problem ? "unavailable" : "ready";
  if (problem) answer["tracks_problem"] = *problem;
  return json_response(answer);
}

http::Response metrics(const Service& service, const http::Request& /*unused*/) {
  return {200, "text/plain; version=0.0.4", service.metrics.text()};
}

http::Response openapi(const Service& /*unused*/, const http::Request& /*unused*/) {
  return {200, "application/json", std::string(schema::openapi_json())};
}

http::Response limits(const Service& service, const http::Request& /*unused*/) {
  return json_response({{"body_bytes", service.http.body_bytes},
                        {"pixels", service.limits.pixels},
                        {"cells", service.limits.cells},
                        {"poses", service.limits.poses},
                        {"search_km2", service.limits.search_km2},
                        {"json_depth", api::kJsonDepth},
                        {"modes", service.limits.modes},
                        {"particles", service.limits.particles},
                        {"tracks", service.tracks.limits().tracks},
                        {"tracks_per_client", service.tracks.limits().tracks_per_client},
                        {"track_idle_s", std::chrono::duration<double>(service.tracks.limits().idle).count()},
                        {"frames", service.limits.frames},
                        {"body_time_ms", service.http.connection.body.count()},
                        {"request_time_ms", service.http.request_time.count()},
                        {"turn_time_ms", service.http.turn_time.count()},
                        {"searches_at_once", service.http.heavy_running},
                        {"searches_waiting", service.http.heavy_waiting}});
}

}  // namespace

void add_operations_routes(Routes& routes) {
  routes.add("GET", "/healthz", {}, health);
  routes.add("GET", "/readyz", {}, ready);
  routes.add("GET", "/metrics", {}, metrics);
  routes.add("GET", "/openapi.json", {}, openapi);
  routes.add("GET", "/v1/limits", {}, limits);
}

}  // namespace roadfix::server
