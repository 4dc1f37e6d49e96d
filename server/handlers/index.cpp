#include <fmt/format.h>

#include "server/handlers/handlers.hpp"

namespace roadfix::server {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result.push_back(c);
    }
  }
  return result;
}

std::string percent_encoded(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool is_plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_' || c == '.';
    result += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return result;
}

std::string page(const Service& service) {
  std::string rows;
  for (const auto& map : service.maps.maps()) {
    const std::string at = "/v1/maps/" + percent_encoded(map->name);
    rows += fmt::format("<tr><td><a href=\"{0}\">{1}</a><td>{2} m<td><a href=\"{0}/tilejson.json\">tilejson</a></tr>\n",
                        at, escaped(map->name), map->view.cell_m);
  }
  for (const UnreadableMap& map : service.maps.unreadable()) {
    rows += fmt::format("<tr><td>{}<td colspan=2>unreadable: {}</tr>\n", escaped(map.name), escaped(map.reason));
  }
  if (rows.empty()) rows = "<tr><td colspan=3>no map is in the folder yet: roadfix ingest makes one</tr>\n";
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Roadfix</title>\n"
      "<style>body{{font:16px/1.5 sans-serif;max-width:50rem;margin:2rem auto;padding:0 1rem}}td{{padding:.2rem 1rem "
      ".2rem 0}}</style>\n"
      "<h1>Roadfix</h1><p>Localizes UAVs by roads. <a href=\"/openapi.json\">Every route</a>, <a "
      "href=\"/v1/limits\">limits</a>, "
      "<a href=\"/metrics\">metrics</a>.</p>\n<table><tr><th>map<th>cells<th>tiles</tr>\n{}</table>\n</html>\n",
      rows);
}

}  // namespace

void add_index_route(http::Router& router, const Service& service) {
  router.add({"GET", "/", {}, false, [&service](const http::Request&) {
                return http::Response{200, "text/html; charset=utf-8", page(service)};
              }});
}

}  // namespace roadfix::server
