#include "cli/bench/told_prior.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "cli/bench/queries.hpp"
#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

using evaluation::Random;

constexpr const char* kPriorOutsideMap = "prior-outside-map";

/// Uniform over the disc, so that the truth is anywhere in the circle that is told; or outside of it.
GridPoint centre_of_prior(const GridPoint& truth, const QuerySet& set, Random& random) {
  const double within = *set.prior_radius_m * std::sqrt(uniform(random, 0.0, 1.0));
  const double radius = set.prior_beyond_m ? *set.prior_radius_m + *set.prior_beyond_m : within;
  const double direction = uniform(random, 0.0, 2.0 * std::numbers::pi);
  return {truth.east_m + radius * std::cos(direction), truth.north_m + radius * std::sin(direction)};
}

/// nullopt where none meets the map.
std::optional<GeoCircle> circle_around(const GridPoint& truth, const QuerySet& set, const MapView& map,
                                       Random& random) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    const GridPoint centre = centre_of_prior(truth, set, random);
    if (!contains({centre, *set.prior_radius_m}, nearest(map.extent, centre))) continue;
    return GeoCircle{map.zone.unproject(centre), *set.prior_radius_m};
  }
  return std::nullopt;
}

}  // namespace

void tell_prior(Query& query, const GridPoint& truth, Angle true_heading, const QuerySet& set, const MapView& map,
                Random& random) {
  if (set.prior_radius_m) {
    query.prior.circle = circle_around(truth, set, map, random);
    if (!query.prior.circle) {
      query.unasked = kPriorOutsideMap;
      if (!map.extent.contains(truth)) return;
      throw InvalidInput(kPriorOutsideMap,
                         fmt::format("{}: no such circle meets the map '{}'", describe(set), map.id.name));
    }
  }
  if (const auto range = set.prior_heading_range) {
    query.prior.heading = HeadingRange{(true_heading + uniform(random, -1.0, 1.0) * *range).wrapped(), *range};
  }
}

}  // namespace roadfix::bench
