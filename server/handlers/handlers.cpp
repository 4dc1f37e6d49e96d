#include "server/handlers/handlers.hpp"

#include <utility>

namespace roadfix::server {

std::shared_ptr<http::Admission> turns_of(const Service& service) {
  return std::make_shared<http::Admission>(service.http.heavy_running, service.http.threads / kThreadsPerWaiting);
}

void Routes::add(const char* method, const char* path, std::vector<std::string> parameters,
                 Handler<http::Response> handler, http::Load load) {
  router_.add({method, path, std::move(parameters), load,
               [&service = service_, handler = std::move(handler)](const http::Request& request) {
                 return handler(service, request);
               }});
}

void Routes::add_prepared(const char* method, const char* path, std::vector<std::string> parameters, Prepare prepare) {
  http::Route route{method, path, std::move(parameters), http::Load::kLive, {}};
  route.prepare = [&service = service_, prepare = std::move(prepare)](http::Request& request) {
    return prepare(service, request);
  };
  router_.add(std::move(route));
}

}  // namespace roadfix::server
