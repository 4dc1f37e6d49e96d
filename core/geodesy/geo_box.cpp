#include "core/geodesy/geo_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace roadfix {
namespace {

double central_meridian_deg(const UtmZone& zone) { return 6.0 * zone.number() - 183.0; }

/// Degrees; longitudes are counted from the central meridian of the zone.
struct NearBox {
  double south, north, west, east;
  bool empty() const { return !(south < north) || !(west < east); }
};

/// Of the box turned around the Earth.
NearBox near_place(const UtmZone& zone, const GeoBox& box, const GridBox& place, double turn_deg) {
  constexpr double kMarginDeg = 0.1;
  const double meridian = central_meridian_deg(zone);
  const GeoBox around = geo_box_around(zone, place);
  const double first = std::remainder(around.south_west.lon_deg - meridian, 360.0);
  const double last = first + around.north_east.lon_deg - around.south_west.lon_deg;
  const double west = std::remainder(box.south_west.lon_deg - meridian, 360.0) + turn_deg;
  const double east = west + box.north_east.lon_deg - box.south_west.lon_deg;
  return {std::max(box.south_west.lat_deg, around.south_west.lat_deg - kMarginDeg),
          std::min(box.north_east.lat_deg, around.north_east.lat_deg + kMarginDeg), std::max(west, first - kMarginDeg),
          std::min(east, last + kMarginDeg)};
}

GridBox on_plane(const UtmZone& zone, const NearBox& part) {
  GridBox result = kEmptyBox;
  if (part.empty()) return result;
  // A parallel turns at the central meridian, a meridian at the equator.
  for (const double lat : {part.south, std::clamp(0.0, part.south, part.north), part.north}) {
    for (const double lon : {part.west, std::clamp(0.0, part.west, part.east), part.east}) {
      const GridPoint p = zone.project({lat, central_meridian_deg(zone) + lon});
      result = united(result, {p, p});
    }
  }
  return result;
}

GridSide meridian_of(const UtmZone& zone, const NearBox& part, double lon) {
  const auto at = [&](double lat) {
    const GridPoint p = zone.project({lat, central_meridian_deg(zone) + lon});
    return GridSide::Point{p.north_m, p.east_m};
  };
  return GridSide({at(part.south), at(std::midpoint(part.south, part.north)), at(part.north)});
}

GridSide parallel_of(const UtmZone& zone, const NearBox& part, double lat) {
  const auto at = [&](double lon) {
    const GridPoint p = zone.project({lat, central_meridian_deg(zone) + lon});
    return GridSide::Point{p.east_m, p.north_m};
  };
  return GridSide({at(part.west), at(std::midpoint(part.west, part.east)), at(part.east)});
}

// The box may reach a place around the Earth, or from both sides.
constexpr std::array kTurnsDeg{0.0, -360.0};

}  // namespace

std::optional<GeoBox> told_box(std::span<const double, 4> sides_deg) {
  constexpr double kTurn = 360.0;
  const auto [west, south, east, north] = std::array{sides_deg[0], sides_deg[1], sides_deg[2], sides_deg[3]};
  if (std::max(std::abs(west), std::abs(east)) > kTurn) return std::nullopt;
  if (std::max(std::abs(south), std::abs(north)) > 90.0) return std::nullopt;
  const GeoBox box{{south, west}, {north, west - east > kTurn / 2.0 ? east + kTurn : east}};
  return box.empty() ? std::nullopt : std::optional(box);
}

GeoBox geo_box_around(const UtmZone& zone, const GridBox& box) {
  // Along a side the extreme lies between samples by less than its curvature over one step: centimetres for a city.
  constexpr int kSteps = 16;
  const double somewhere_deg = zone.unproject(box.min).lon_deg;
  GeoBox bounds{{90.0, 540.0}, {-90.0, -540.0}};
  for (int i = 0; i <= kSteps; ++i) {
    const double east = box.min.east_m + box.width_m() * i / kSteps;
    const double north = box.min.north_m + box.height_m() * i / kSteps;
    for (const GridPoint p : {GridPoint{east, box.min.north_m}, GridPoint{east, box.max.north_m},
                              GridPoint{box.min.east_m, north}, GridPoint{box.max.east_m, north}}) {
      LatLon at = zone.unproject(p);
      at.lon_deg = somewhere_deg + std::remainder(at.lon_deg - somewhere_deg, 360.0);
      bounds.south_west = {std::min(bounds.south_west.lat_deg, at.lat_deg),
                           std::min(bounds.south_west.lon_deg, at.lon_deg)};
      bounds.north_east = {std::max(bounds.north_east.lat_deg, at.lat_deg),
                           std::max(bounds.north_east.lon_deg, at.lon_deg)};
    }
  }
  return bounds;
}

GridBox grid_box_around(const UtmZone& zone, const GeoBox& box, const GridBox& place) {
  GridBox result = kEmptyBox;
  if (place.empty()) return result;
  for (const double turn_deg : kTurnsDeg) {
    result = united(result, on_plane(zone, near_place(zone, box, place, turn_deg)));
  }
  return result;
}

std::vector<GridQuad> grid_quads_of(const UtmZone& zone, const GeoBox& box, const GridBox& place) {
  std::vector<GridQuad> quads;
  for (const double turn_deg : kTurnsDeg) {
    const NearBox part = near_place(zone, box, place, turn_deg);
    if (part.empty()) continue;
    quads.push_back({meridian_of(zone, part, part.west), meridian_of(zone, part, part.east),
                     parallel_of(zone, part, part.south), parallel_of(zone, part, part.north)});
  }
  return quads;
}

}  // namespace roadfix
