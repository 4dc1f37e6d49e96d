#include "core/locate/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/resample.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr double kLargestSideM = 20'000.0;
constexpr int kMostCellsAcross = 8192;

void require_usable(const FeatureMap& features) {
  if (features.cells.empty()) {
    throw InvalidInput("feature-map-empty", "the feature map has no cells: give at least one row and one column");
  }
  if (!std::isfinite(features.cell_m) || features.cell_m <= 0.0) {
    throw InvalidInput("cell-size-out-of-range",
                       fmt::format("the feature map's cell size is {} m: give the side of a cell on the ground, in "
                                   "metres above 0",
                                   features.cell_m));
  }
  const double side_m = features.cell_m * std::max(features.cells.cols(), features.cells.rows());
  if (side_m > kLargestSideM) {
    throw InvalidInput("feature-map-too-large",
                       fmt::format("the feature map spans {:.6g} m, more than {:.0f} m: check its cell size ({} m)",
                                   side_m, kLargestSideM, features.cell_m));
  }
  const double off_m = features.cell_m * std::hypot(features.nadir.col - features.cells.cols() / 2.0,
                                                    features.nadir.row - features.cells.rows() / 2.0);
  if (!(off_m <= kLargestSideM)) {
    throw InvalidInput("nadir-out-of-range", "the point below the UAV lies too far from its feature map");
  }
}

GridCircle circle_in(const UtmZone& zone, const GeoCircle& circle) {
  if (!std::isfinite(circle.radius_m) || circle.radius_m <= 0.0) {
    throw InvalidInput("prior-radius-out-of-range",
                       fmt::format("the radius of the prior is {} m: give metres above 0", circle.radius_m));
  }
  return {zone.project(circle.centre), circle.radius_m};
}

/// Central meridian of the zone.
double meridian_deg(const UtmZone& zone) { return 6.0 * zone.number() - 183.0; }

/// Degrees; longitudes are counted from the central meridian of the map's zone.
struct NearBox {
  double south, north, west, east;
};

/// What of the box lies within some kilometres of the map: UTM is not defined everywhere.
NearBox near_map(const MapView& map, const GeoBox& box) {
  constexpr double kMarginDeg = 0.1;  // more than the sides of a map curve between its corners
  const double meridian = meridian_deg(map.zone);
  NearBox bounds{90.0, -90.0, 360.0, -360.0};
  for (const double east_m : {map.extent.min.east_m, map.extent.max.east_m}) {
    for (const double north_m : {map.extent.min.north_m, map.extent.max.north_m}) {
      const LatLon at = map.zone.unproject({east_m, north_m});
      const double lon = std::remainder(at.lon_deg - meridian, 360.0);
      bounds = {std::min(bounds.south, at.lat_deg), std::max(bounds.north, at.lat_deg), std::min(bounds.west, lon),
                std::max(bounds.east, lon)};
    }
  }
  double west = std::remainder(box.south_west.lon_deg - meridian, 360.0);
  if (west > bounds.east + kMarginDeg) west -= 360.0;  // it may reach the map around the Earth
  const double east = west + box.north_east.lon_deg - box.south_west.lon_deg;
  return {std::max(box.south_west.lat_deg, bounds.south - kMarginDeg),
          std::min(box.north_east.lat_deg, bounds.north + kMarginDeg), std::max(west, bounds.west - kMarginDeg),
          std::min(east, bounds.east + kMarginDeg)};
}

/// Smallest box of the grid around what of the geographic one lies near the map; empty where nothing does. Its sides
/// are curves there: a parallel turns at the central meridian, a meridian at the equator.
GridBox box_in(const MapView& map, const GeoBox& box) {
  if (!(box.south_west.lat_deg < box.north_east.lat_deg) || !(box.south_west.lon_deg < box.north_east.lon_deg)) {
    throw InvalidInput(
        "prior-box-empty",
        fmt::format("the box of the prior runs from {}, {} to {}, {}: the first corner must lie south and "
                    "west of the second",
                    box.south_west.lat_deg, box.south_west.lon_deg, box.north_east.lat_deg, box.north_east.lon_deg));
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  GridBox result{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  const NearBox part = near_map(map, box);
  if (!(part.south < part.north) || !(part.west < part.east)) return result;
  for (const double lat : {part.south, std::clamp(0.0, part.south, part.north), part.north}) {
    for (const double lon : {part.west, std::clamp(0.0, part.west, part.east), part.east}) {
      const GridPoint p = map.zone.project({lat, meridian_deg(map.zone) + lon});
      result = united(result, {p, p});
    }
  }
  return result;
}

}  // namespace

FeatureMap in_cells_of(const MapView& map, const FeatureMap& features) {
  require_usable(features);
  double cell_m = map.cell_m;
  while (2.0 * cell_m <= 1.01 * features.cell_m) cell_m *= 2.0;
  const double cells_across = features.cell_m * std::max(features.cells.cols(), features.cells.rows()) / cell_m;
  if (cells_across > kMostCellsAcross) {
    throw InvalidInput("feature-map-too-large",
                       fmt::format("the feature map spans {:.0f} cells of the map, more than {}: give a smaller window",
                                   cells_across, kMostCellsAcross));
  }
  if (features.cell_m == cell_m) return features;
  return resampled(features, cell_m);
}

PoseRegion region_of(const MapView& map, const Prior& prior) {
  if (map.extent.empty() || map.extent.width_m() <= 0.0 || map.extent.height_m() <= 0.0) {
    throw InvalidInput("map-unobserved",
                       fmt::format("the map {} holds no observed cell: ingest imagery or roads first", map.name));
  }
  PoseRegion region;
  region.box = map.extent;
  if (prior.circle) {
    region.circle = circle_in(map.zone, *prior.circle);
    const auto& [centre, radius_m] = *region.circle;
    region.box = intersection(region.box, grown({centre, centre}, radius_m));
  }
  if (prior.box) region.box = intersection(region.box, box_in(map, *prior.box));
  const GridPoint middle = region.box.centre();
  if (region.box.empty() || (region.circle && !contains(*region.circle, nearest(region.box, region.circle->centre)))) {
    throw InvalidInput(
        "prior-outside-map",
        fmt::format("the prior does not meet the map {}: check its position, or search without it", map.name));
  }
  if (prior.heading) {
    const double half_deg = prior.heading->half_width.degrees();
    if (!(half_deg >= 0.0) || !std::isfinite(half_deg) || !(std::abs(prior.heading->centre.degrees()) <= 360.0)) {
      throw InvalidInput(
          "prior-heading-out-of-range",
          "the heading range must be given as a heading of -360 to 360 and half a width of 0 to 180 degrees");
    }
    region.heading = map.zone.grid_from_true(prior.heading->centre, middle);
    region.heading_half_width = Angle::degrees(std::min(half_deg, 180.0));
  }
  return region;
}

}  // namespace roadfix
