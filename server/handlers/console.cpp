#include <algorithm>
#include <functional>

#include "core/units/error.hpp"
#include "server/console/files.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

/// The page loads nothing from elsewhere and sends nothing elsewhere.
constexpr const char* kPolicy = "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'";

http::Response get_file(const http::Request& request, std::string_view name) {
  const auto files = console::files();
  const auto file = std::ranges::find(files, name, &console::File::name);
  if (file == files.end()) throw NotFound("route-not-found", "the console has no file of that name");
  const std::string tag = entity_tag(std::to_string(std::hash<std::string_view>{}(file->content)), std::string(name));
  http::Response response{304, {}, {}, {{"ETag", tag}, {"Cache-Control", "no-cache"}}};
  if (is_known_to_client(request, tag)) return response;
  response.status = 200;
  response.content_type = file->content_type;
  response.body = file->content;
  response.headers.emplace_back("Content-Security-Policy", kPolicy);
  return response;
}

}  // namespace

void add_console_routes(Routes& routes) {
  routes.add("GET", "/", {},
             [](const Service&, const http::Request& request) { return get_file(request, "index.html"); });
  routes.add("GET", "/console/{file}", {}, [](const Service&, const http::Request& request) {
    return get_file(request, request.path_parameters.at("file"));
  });
}

}  // namespace roadfix::server
