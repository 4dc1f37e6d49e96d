// One file per resource; each adds its routes.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/http/admission.hpp"
#include "server/http/router.hpp"
#include "server/service.hpp"

namespace roadfix::server {

/// In a queue that is not the one of heavy requests at most one request waits per so many threads: most of the
/// service's connections are left to others.
inline constexpr int kThreadsPerWaiting = 4;

/// Such a queue, of requests that take much memory: as many run as of the heavy ones, whose turns are longer.
std::shared_ptr<http::Admission> turns_of(const Service& service);

/// Where a resource adds its routes: what answers them is called with the service.
class Routes {
 public:
  template <typename Answer>
  using Handler = std::function<Answer(const Service&, const http::Request&)>;

  /// `service` must outlive the router's handlers.
  Routes(http::Router& router, const Service& service) : router_(router), service_(service) {}

  void add(const char* method, const char* path, std::vector<std::string> parameters, Handler<http::Response> handler,
           http::Load load = http::Load::kLight);
  /// See http::Route::prepare.
  using Prepare = std::function<http::Prepared(const Service&, http::Request&)>;
  void add_prepared(const char* method, const char* path, std::vector<std::string> parameters, Prepare prepare);
  const Service& service() const { return service_; }

 private:
  http::Router& router_;
  const Service& service_;
};

/// / and /console/{file}: the operator's page
void add_console_routes(Routes& routes);
/// /healthz, /readyz, /metrics, /openapi.json, /v1/limits
void add_operations_routes(Routes& routes);
void add_map_routes(Routes& routes);
void add_window_route(Routes& routes);
void add_tile_routes(Routes& routes);
void add_match_route(Routes& routes);
void add_fix_route(Routes& routes);
/// The answer for a place, and tiles of them
void add_localizability_routes(Routes& routes);
void add_detect_route(Routes& routes);
void add_track_routes(Routes& routes);

}  // namespace roadfix::server
