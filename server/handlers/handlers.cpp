#include "server/handlers/handlers.hpp"

#include <utility>

namespace roadfix::server {

void Routes::add(const char* method, const char* path, std::vector<std::string> parameters,
                 Handler<http::Response> handler, http::Load load) {
  router_.add({method, path, std::move(parameters), load,
               [&service = service_, handler = std::move(handler)](const http::Request& request) {
                 return handler(service, request);
               }});
}

void Routes::add_prepared(const char* method, const char* path, std::vector<std::string> parameters, Prepare prepare) {
  http::Route route{method, path, std::move(parameters), http::Load::kHeavy, {}};
  route.prepare = [&service = service_, prepare = std::move(prepare)](http::Request& request) {
    return prepare(service, request);
  };
  router_.add(std::move(route));
}

}  // namespace roadfix::server
