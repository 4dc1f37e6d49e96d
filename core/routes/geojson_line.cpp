#include "core/routes/geojson_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

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

/// Itself, or the members of a collection.
void add_geometry(const JsonField& geometry, std::vector<JsonField>& geometries) {
  if (geometry.is_null()) return;
  if (!geometry.has("geometries")) return geometries.push_back(geometry);
  for (const JsonField& member : geometry.at("geometries").elements()) geometries.push_back(member);
}

std::vector<JsonField> geometries_of(const JsonField& document) {
  std::vector<JsonField> geometries;
  if (document.has("features")) {
    for (const JsonField& feature : document.at("features").elements()) {
      add_geometry(feature.at("geometry"), geometries);
    }
  } else {
    add_geometry(document.has("geometry") ? document.at("geometry") : document, geometries);
  }
  return geometries;
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

/// The first line, with a word on the others, or else all points. Refuses what holds areas alone.
Route line_in(const JsonField& document) {
  Route line;
  Route points;
  std::optional<JsonField> area;
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
    if (type == "MultiPoint") add_line(geometry.at("coordinates"), points);
    if (type.ends_with("Polygon")) area.emplace(geometry);
  }
  if (line.places.empty() && points.places.empty() && area) {
    area->refuse("is a polygon, which tells no way: draw a line");
  }
  return line.places.empty() ? points : line;
}

/// Lines that lie on the ground have heights of 0 where they were KML, as Google Earth draws them.
void forget_heights_of_zero(std::vector<RoutePlace>& places) {
  const auto is_zero = [](const RoutePlace& place) { return place.height && place.height->metres == 0.0; };
  if (!std::ranges::all_of(places, is_zero)) return;
  for (RoutePlace& place : places) place.height.reset();
}

}  // namespace

Route parse_geojson_line(const JsonField& document) {
  Route route = line_in(document);
  forget_heights_of_zero(route.places);
  if (!route.places.empty()) route.home.position = route.places.front().position;
  return route;
}

}  // namespace roadfix::routes
