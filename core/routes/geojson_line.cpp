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

Route line_in(const JsonField& document) {
  Route points;
  for (const JsonField& geometry : geometries_of(document)) {
    const std::string type = geometry.at("type").text();
    Route line;
    if (type == "LineString") {
      add_line(geometry.at("coordinates"), line);
      return line;
    }
    if (type == "MultiLineString") {
      for (const JsonField& part : geometry.at("coordinates").elements()) add_line(part, line);
      return line;
    }
    if (type == "Point") add_place(geometry.at("coordinates"), points);
  }
  return points;
}

}  // namespace

Route parse_geojson_line(const JsonField& document) {
  Route route = line_in(document);
  if (!route.places.empty()) route.home.position = route.places.front().position;
  return route;
}

}  // namespace roadfix::routes
