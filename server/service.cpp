#include "server/service.hpp"

#include "server/handlers/handlers.hpp"

namespace roadfix::server {

http::Router make_router(const Service& service) {
  http::Router router;
  Routes routes(router, service);
  add_console_routes(routes);
  add_operations_routes(routes);
  add_map_routes(routes);
  add_window_route(routes);
  add_tile_routes(routes);
  add_match_route(routes);
  add_fix_route(routes);
  add_localizability_routes(routes);
  add_detect_route(routes);
  add_track_routes(routes);
  return router;
}

}  // namespace roadfix::server
