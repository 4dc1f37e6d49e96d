#include "core/survey/flight_heights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/units/error.hpp"

namespace roadfix {

double DownwardCamera::footprint_m(double agl_m) const {
  const double across_m = 2.0 * std::max(agl_m, 0.0) * std::tan(horizontal_fov.radians() / 2.0);
  return across_m / std::sqrt(aspect);
}

FlightHeights::FlightHeights(const MapView& map, const routes::Route& route, std::optional<double> usual_agl_m)
    : map_(map) {
  for (const routes::RoutePlace& place : route.places) places_.push_back(height_of(route, place, usual_agl_m));
}

std::optional<double> FlightHeights::agl_m(std::size_t from, double share, GridPoint point) const {
  assert(from + 1 < places_.size());
  const Height& begin = places_[from];
  const Height& end = places_[from + 1];
  if (begin.agl_m && end.agl_m) return std::lerp(*begin.agl_m, *end.agl_m, share);
  const auto ground = map_.terrain ? map_.terrain->height_m(point) : std::nullopt;
  if (!begin.above_sea_m || !end.above_sea_m || !ground) return std::nullopt;
  return std::lerp(*begin.above_sea_m, *end.above_sea_m, share) - *ground;
}

FlightHeights::Height FlightHeights::height_of(const routes::Route& route, const routes::RoutePlace& place,
                                               std::optional<double> usual_agl_m) const {
  using enum routes::HeightAbove;
  auto height = place.height;
  if (!height && usual_agl_m) height = routes::PlannedHeight{*usual_agl_m, kGround};
  if (!height) {
    throw InvalidInput("heights-missing",
                       fmt::format("the route tells no height for {} ({:.6f} {:.6f}): plan one, or give the height "
                                   "above ground of such places (--agl, agl_m)",
                                   place.name, place.position.lat_deg, place.position.lon_deg));
  }
  if (height->above == kHome && map_.terrain) return {std::nullopt, home_ground_m(route.home) + height->metres};
  if (height->above != kSea) {
    const auto ground = ground_m(place.position);
    return {height->metres, ground ? std::optional(*ground + height->metres) : std::nullopt};
  }
  if (map_.terrain) return {std::nullopt, height->metres};
  throw InvalidInput("terrain-missing",
                     fmt::format("the route tells the height of {} above the sea, and the map {} does not know how "
                                 "high its ground is: add heights with roadfix terrain, or plan heights above the home "
                                 "or the ground",
                                 place.name, map_.id.name));
}

double FlightHeights::home_ground_m(const routes::RouteHome& home) const {
  if (const auto ground = ground_m(home.position)) return *ground;
  if (home.above_sea_m) return *home.above_sea_m;
  throw InvalidInput("terrain-missing",
                     fmt::format("the heights of the route count from the ground of its home ({:.6f} {:.6f}), and "
                                 "neither the route nor the map {} says how high that is: plan the height of the home, "
                                 "or add heights of its ground with roadfix terrain",
                                 home.position.lat_deg, home.position.lon_deg, map_.id.name));
}

std::optional<double> FlightHeights::ground_m(LatLon place) const {
  const auto point = map_.zone.project_if_defined(place);
  return map_.terrain && point ? map_.terrain->height_m(*point) : std::nullopt;
}

}  // namespace roadfix
