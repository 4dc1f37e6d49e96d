#include "server/service.hpp"

#include "server/handlers/handlers.hpp"

namespace roadfix::server {

http::Router make_router(const Service& service) {
  http::Router router;
  add_console_routes(router);
  add_operations_routes(router, service);
  add_map_routes(router, service);
  add_window_route(router, service);
  add_tile_routes(router, service);
  add_match_route(router, service);
  add_fix_route(router, service);
  add_localizability_routes(router, service);
  add_detect_route(router, service);
  add_track_routes(router, service);
  return router;
}

}  // namespace roadfix::server
