#include "core/routes/geojson_line.hpp"

#include <fmt/format.h>

#include "core/routes/route_json.hpp"

namespace roadfix::routes {
namespace {

void add_place(const JsonField& field, Route& route) {
  const std::vector<JsonField> numbers = field.elements();
  if (numbers.size() < 2) field.refuse("has to be a longitude and a latitude");
  RoutePlace place{{latitude_of(numbers[1]), longitude_of(numbers[0])}, std::nullopt, {}};
  if (const auto above_sea_m = third_number(numbers)) place.height = PlannedHeight{*above_sea_m, HeightAbove::kSea};
  place.name = fmt::format("place {}", route.places.size() + 1);
  route.places.push_back(std::move(place));
}

std::vector<JsonField> geometries_of(const JsonField& document) {
  if (document.has("features")) {
    std::vector<JsonField> geometries;
    for (const JsonField& feature : document.at("features").elements()) {
      const JsonField geometry = feature.at("geometry");
      if (!geometry.is_null()) geometries.push_back(geometry);
    }
    return geometries;
  }
  return {document.has("geometry") ? document.at("geometry") : document};
}

void add_line(const JsonField& positions, Route& route) {
  for (const JsonField& place : positions.elements()) add_place(place, route);
}

void add_lines(const JsonField& geometry, const std::string& type, Route& route) {
  const JsonField coordinates = geometry.at("coordinates");
  if (type == "LineString") {
    add_line(coordinates, route);
  } else {
    for (const JsonField& part : coordinates.elements()) add_line(part, route);
  }
}

/// The first line, with a word on the others, or else all points.
Route line_in(const JsonField& document) {
  Route line;
  Route points;
  int number = 0;
  for (const JsonField& geometry : geometries_of(document)) {
    ++number;
    const std::string type = geometry.at("type").text();
    if (type == "LineString" || type == "MultiLineString") {
      if (line.places.empty()) {
        add_lines(geometry, type, line);
      } else {
        line.left_out.push_back(
            fmt::format("geometry {}, a {}: a route is one line, and the first one is taken", number, type));
      }
    }
    if (type == "Point") add_place(geometry.at("coordinates"), points);
  }
  return line.places.empty() ? points : line;
}

}  // namespace

Route parse_geojson_line(const JsonField& document) {
  Route route = line_in(document);
  if (!route.places.empty()) route.home.position = route.places.front().position;
  return route;
}

}  // namespace roadfix::routes
