#include "core/survey/localizability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/geodesy/shown_ground.hpp"
#include "core/grid/cell_moments.hpp"
#include "core/locate/footprint_refusal.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr double kMaxFootprintCells = 4096.0;  // in finer cells large footprints would take gigabytes

/// The cells of the map, or where a footprint has too many of them, those of an overview.
double cell_for(const MapView& map, double footprint_m) {
  double cell_m = map.cell_m;
  while (footprint_m > kMaxFootprintCells * cell_m) cell_m *= 2.0;
  return cell_m;
}

/// Cells enough for the footprint at any error of scale and tilt.
RoadGrid around(const MapView& map, GridPoint centre, double footprint_m) {
  return map.read(GridGeometry::covering(grown({centre, centre}, footprint_m), cell_for(map, footprint_m)));
}

/// Within two standard deviations, or four cells where those are more.
bool is_at(const FixMode& mode, GridPoint place, const UtmZone& zone, double cell_m) {
  return distance_m(zone.project(mode.pose.position), place) <= std::max(4.0 * cell_m, 2.0 * mode.ellipse.sigma_m[0]);
}

}  // namespace

PlaceKind kind_of(const Localizability& place) {
  if (place.observed_share < kMinObservedShare) return PlaceKind::kUnknown;
  if (place.status == FixStatus::kFix) return PlaceKind::kDistinct;
  return place.bare ? PlaceKind::kBare : PlaceKind::kSparse;
}

Localizability localizability(const MapView& map, const LocalizabilityQuery& query) {
  if (!(query.footprint_m >= kSmallestFootprintM && query.footprint_m <= kLargestFootprintM)) {
    throw InvalidInput("parameter-out-of-range",
                       fmt::format("the footprint is {} m: give {} to {} m", query.footprint_m, kSmallestFootprintM,
                                   kLargestFootprintM));
  }
  const GridPoint place = map.zone.project(query.position);
  if (!map.extent.empty() && !contains({place, query.radius_m}, nearest(map.extent, place))) {
    throw InvalidInput("prior-outside-map", fmt::format("the place lies outside the map {}, {}: check it", map.id.name,
                                                        shown_ground_beside({query.position, query.position},
                                                                            query.radius_m, map.zone, map.extent)));
  }
  const RoadGrid ground = around(map, place, query.footprint_m);
  const double cell_m = ground.geometry.cell_m;
  const int cells = std::max(1, static_cast<int>(std::lround(query.footprint_m / cell_m)));
  std::mt19937_64 random(1);  // a place has one answer
  const FeatureMap as_mapped = simulate_features(ground, {place, {}}, cells, cells, {}, random);
  const FeatureMap seen = simulate_features(ground, {place, {}}, cells, cells, query.quality, random);

  Prior prior;
  prior.circle = GeoCircle{query.position, query.radius_m};
  const Fix fix = locate(map, seen, prior, query.fix);
  Localizability result;
  result.bare = shows_less_than_a_road_across(seen);
  result.road_share = moments_of(as_mapped.cells).mean();
  result.observed_share =
      static_cast<double>(as_mapped.cells.observed_count()) / static_cast<double>(as_mapped.cells.cells().size());
  const bool found = !fix.modes.empty() && is_at(fix.modes.front(), place, map.zone, cell_m);
  result.reason = fix.reason;
  result.complete = fix.complete;
  result.explanation = fix.explanation;
  if (found) {
    result.status = fix.status;
    result.probability = fix.probability;
  } else if (!fix.modes.empty() && fix.complete) {
    result.reason = "wrong-place";
    result.explanation = "a frame of this place fits better elsewhere: its roads repeat, or are too few to tell it by";
  }
  std::ranges::copy_if(fix.modes, std::back_inserter(result.alike),
                       [&](const FixMode& mode) { return !is_at(mode, place, map.zone, cell_m); });
  return result;
}

}  // namespace roadfix
