// One file per resource; each adds its routes.
#pragma once

#include <string>

#include "server/http/router.hpp"
#include "server/service.hpp"

namespace roadfix::server {

/// In a queue that is not the one of heavy requests at most one request waits per so many threads: most of the
/// service's connections are left to others.
inline constexpr int kThreadsPerWaiting = 4;

/// / and /console/{file}: the operator's page
void add_console_routes(http::Router& router);
/// /healthz, /readyz, /metrics, /openapi.json, /v1/limits
void add_operations_routes(http::Router& router, const Service& service);
void add_map_routes(http::Router& router, const Service& service);
void add_window_route(http::Router& router, const Service& service);
void add_tile_routes(http::Router& router, const Service& service);
void add_match_route(http::Router& router, const Service& service);
void add_fix_route(http::Router& router, const Service& service);
/// The answer for a place, and tiles of them
void add_localizability_routes(http::Router& router, const Service& service);
void add_detect_route(http::Router& router, const Service& service);
void add_track_routes(http::Router& router, const Service& service);

}  // namespace roadfix::server
