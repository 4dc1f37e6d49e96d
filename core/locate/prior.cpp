#include "core/locate/prior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/geodesy/shown_ground.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

GridCircle circle_in(const UtmZone& zone, const GeoCircle& circle) {
  if (!std::isfinite(circle.radius_m) || circle.radius_m <= 0.0) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("the radius of the prior is {} m: give metres above 0", circle.radius_m));
  }
  return {zone.project(circle.centre), circle.radius_m};
}

std::vector<GridQuad> quads_in(const MapView& map, const GeoBox& box) {
  if (box.empty()) {
    throw InvalidInput(
        "parameter-out-of-range",
        fmt::format("the box of the prior runs from {}, {} to {}, {}: the first corner must lie south and "
                    "west of the second",
                    box.south_west.lat_deg, box.south_west.lon_deg, box.north_east.lat_deg, box.north_east.lon_deg));
  }
  return grid_quads_of(map.zone, box, map.extent);
}

/// The smallest box around the parts of `box` that lie in the quads; empty if there are none.
GridBox within(const std::vector<GridQuad>& quads, const GridBox& box) {
  GridBox result = kEmptyBox;
  for (const GridQuad& quad : quads) {
    const GridBox part = quad.within(box);
    if (!part.empty()) result = united(result, part);
  }
  return result;
}

bool meet(const GridCircle& circle, const GridBox& box) {
  return !box.empty() && contains(circle, nearest(box, circle.centre));
}

[[noreturn]] void refuse_outside(const MapView& map, const GeoBox& asked, double within_m) {
  throw InvalidInput("prior-outside-map",
                     fmt::format("the prior lies outside the map {}, {}: check its position, or search without it",
                                 map.id.name, shown_ground_beside(asked, within_m, map.zone, map.extent)));
}

/// The largest difference of the convergence within the box from that in its middle.
Angle convergence_range(const UtmZone& zone, const GridBox& box) {
  const Angle middle = zone.convergence(box.centre());
  Angle range;
  for (const GridPoint corner : std::array<GridPoint, 4>{
           {box.min, {box.min.east_m, box.max.north_m}, {box.max.east_m, box.min.north_m}, box.max}}) {
    range = std::max(range, angular_distance(zone.convergence(corner), middle));
  }
  return range;
}

}  // namespace

PoseRegion region_of(const MapView& map, const Prior& prior) {
  if (map.extent.empty() || map.extent.width_m() <= 0.0 || map.extent.height_m() <= 0.0) {
    throw InvalidInput("map-unobserved",
                       fmt::format("the map {} holds no observed cell: ingest imagery or roads first", map.id.name));
  }
  PoseRegion region;
  region.box = map.extent;
  if (prior.circle) {
    region.circle = circle_in(map.zone, *prior.circle);
    const auto& [centre, radius_m] = *region.circle;
    const LatLon told = prior.circle->centre;
    if (!meet(*region.circle, map.extent)) refuse_outside(map, {told, told}, radius_m);
    region.box = intersection(region.box, grown({centre, centre}, radius_m));
  }
  if (prior.box) {
    region.quads = quads_in(map, *prior.box);
    if (within(region.quads, map.extent).empty()) refuse_outside(map, *prior.box, 0.0);
    region.box = within(region.quads, region.box);
    if (region.circle && !meet(*region.circle, region.box)) {
      throw InvalidInput("prior-contradictory",
                         "the circle and the box of the prior have no ground of the map in common: check both, or give "
                         "one of them");
    }
  }
  if (prior.heading) {
    const double half_deg = prior.heading->half_width.degrees();
    if (!(half_deg >= 0.0) || !std::isfinite(half_deg) || !(std::abs(prior.heading->centre.degrees()) <= 360.0)) {
      throw InvalidInput(
          "parameter-out-of-range",
          "the heading range must be given as a heading of -360 to 360 and half a width of 0 to 180 degrees");
    }
    // Grid north turns across the region, and one range of grid headings serves all of it.
    region.heading = map.zone.grid_from_true(prior.heading->centre, region.box.centre());
    region.heading_half_width =
        std::min(Angle::degrees(half_deg) + convergence_range(map.zone, region.box), Angle::degrees(180.0));
  }
  return region;
}

}  // namespace roadfix
