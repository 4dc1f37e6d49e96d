#include "server/api/geojson.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace roadfix::api {
namespace {

using nlohmann::json;
using Stretch = std::vector<LatLon>;

constexpr double kMeridianDeg = 180.0;

bool same(LatLon a, LatLon b) { return a.lat_deg == b.lat_deg && a.lon_deg == b.lon_deg; }

void add_unless_there(Stretch& part, LatLon place) {
  if (!same(part.back(), place)) part.push_back(place);
}

/// Where the shorter way from `a` to `b`, which leads across the meridian, meets it.
double meeting_lat(LatLon a, LatLon b) {
  const double to_meridian = kMeridianDeg - std::abs(a.lon_deg);
  const double beyond = kMeridianDeg - std::abs(b.lon_deg);
  const double share = to_meridian + beyond > 0.0 ? to_meridian / (to_meridian + beyond) : 0.0;
  return a.lat_deg + share * (b.lat_deg - a.lat_deg);
}

json coordinates(const Stretch& part) {
  json list = json::array();
  for (const LatLon& place : part) list.push_back({place.lon_deg, place.lat_deg});
  return list;
}

}  // namespace

std::vector<Stretch> cut_at_180(std::span<const LatLon> places) {
  std::vector<Stretch> parts{{places.front()}};
  for (std::size_t i = 1; i < places.size(); ++i) {
    const LatLon before = places[i - 1];
    const LatLon place = places[i];
    if (std::abs(place.lon_deg - before.lon_deg) <= kMeridianDeg) {
      parts.back().push_back(place);
      continue;
    }
    const double lat_deg = meeting_lat(before, place);
    add_unless_there(parts.back(), {lat_deg, std::copysign(kMeridianDeg, before.lon_deg)});
    parts.push_back({{lat_deg, std::copysign(kMeridianDeg, place.lon_deg)}});
    add_unless_there(parts.back(), place);
  }
  std::erase_if(parts, [](const Stretch& part) { return part.size() < 2; });
  return parts;
}

json point_json(LatLon place) { return {{"type", "Point"}, {"coordinates", {place.lon_deg, place.lat_deg}}}; }

json line_json(std::span<const LatLon> places) {
  const Stretch line(places.begin(), places.end());
  return line_json(std::span(&line, 1));
}

json line_json(std::span<const std::vector<LatLon>> lines) {
  json parts = json::array();
  for (const Stretch& line : lines) {
    for (const Stretch& part : cut_at_180(line)) parts.push_back(coordinates(part));
  }
  if (parts.size() == 1) return {{"type", "LineString"}, {"coordinates", std::move(parts.front())}};
  return {{"type", "MultiLineString"}, {"coordinates", std::move(parts)}};
}

json polygon_json(std::span<const LatLon> ring) {
  std::vector<Stretch> parts = cut_at_180(ring);
  // The ring began amid a part, and ended there.
  if (parts.size() > 1 && same(parts.front().front(), parts.back().back())) {
    parts.back().insert(parts.back().end(), parts.front().begin() + 1, parts.front().end());
    parts.erase(parts.begin());
  }
  json polygons = json::array();
  for (Stretch& part : parts) {
    const bool flat = std::ranges::all_of(part, [&](LatLon p) { return p.lon_deg == part.front().lon_deg; });
    if (flat && parts.size() > 1) continue;  // it touches the meridian only
    add_unless_there(part, part.front());
    polygons.push_back(json::array({coordinates(part)}));
  }
  if (polygons.size() == 1) return {{"type", "Polygon"}, {"coordinates", std::move(polygons.front())}};
  return {{"type", "MultiPolygon"}, {"coordinates", std::move(polygons)}};
}

}  // namespace roadfix::api
