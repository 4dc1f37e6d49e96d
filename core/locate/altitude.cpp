#include "core/locate/altitude.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/match/scales.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr double kSameSize = 0.05;  // the size that a search finds, and the one that the ground gives
constexpr double kNoRange = 0.02;   // no more than heights of the ground err by, or a search can tell

std::optional<HeightRange> ground_of(const MapView& map, const GridBox& box) {
  return map.terrain ? map.terrain->heights_within(box) : std::nullopt;
}

/// The range of scales of one and of the other, one after the other.
double together(double range, double other) { return 1.0 - (1.0 - range) * (1.0 - other); }

Fix unknown_height(const MapView& map, std::string explanation) {
  Fix fix;
  fix.map = map.id;
  fix.reason = kHeightUnknown;
  fix.explanation = std::move(explanation);
  return fix;
}

/// Sizes relative to what they should be at each place, for a search from `agl_m` above ground.
void relate_to_ground(Fix& fix, const MapView& map, double above_sea_m, double agl_m) {
  for (FixMode& mode : fix.modes) {
    mode.agl_m = map.terrain->height_above_ground_m(map.zone.project(mode.pose.position), above_sea_m);
    if (mode.agl_m) mode.scale *= agl_m / *mode.agl_m;
  }
}

/// The roads fit at a place from which they would not be seen in this size.
void require_right_size(Fix& fix, double scale_range) {
  const FixMode& best = fix.modes.front();
  if (best.agl_m && std::abs(std::log(best.scale)) <= max_log_scale(scale_range) + kSameSize) return;
  refuse_place(fix, "terrain-contradicts",
               best.agl_m ? fmt::format("the roads fit best at a place that the UAV should see from {:.0f} m above the "
                                        "ground, in the size that they have from {:.0f} m: check its height above the "
                                        "sea and the heights of the map's ground",
                                        *best.agl_m, *best.agl_m * best.scale)
                          : "the roads fit best at a place where the map does not know the height of its ground, or it "
                            "is above the UAV: check its height above the sea, or give the height above ground");
}

}  // namespace

double AglRange::middle_m() const { return std::sqrt(lowest_m * highest_m); }

double AglRange::scale_range() const { return 1.0 - std::sqrt(lowest_m / highest_m); }

std::optional<AglRange> agl_above(const MapView& map, const GridBox& box, double above_sea_m) {
  const auto ground = ground_of(map, box);
  if (!ground || above_sea_m <= ground->lowest_m) return std::nullopt;
  constexpr double kLeastAglM = 1.0;
  const double highest_m = above_sea_m - ground->lowest_m;
  return AglRange{std::min(highest_m, std::max(kLeastAglM, above_sea_m - ground->highest_m)), highest_m};
}

HeightRange required_ground(const MapView& map, const GridBox& box) {
  if (const auto ground = ground_of(map, box)) return *ground;
  throw InvalidInput("terrain-missing",
                     fmt::format("the map {} does not know how high its ground is there: give the height above "
                                 "ground, or add heights with roadfix terrain",
                                 map.id.name));
}

double required_agl_m(const MapView& map, const GridBox& box, double above_sea_m) {
  if (const auto agl = agl_above(map, box, above_sea_m)) return agl->middle_m();
  throw InvalidInput("below-ground",
                     fmt::format("at {:.0f} m above the sea the UAV would be below the ground, which lies at {:.0f} m "
                                 "and more: check its height above the sea",
                                 above_sea_m, required_ground(map, box).lowest_m));
}

FeatureMap seen_from(FeatureMap features, const Altitude& altitude, double agl_m) {
  const double factor = agl_m / altitude.agl_m;
  features.cell_m *= factor;
  features.nadir_sigma_m *= factor;
  return features;
}

Fix locate_from(const std::optional<Altitude>& altitude, const MapView& map, const FeatureMap& features,
                const Prior& prior, const FixOptions& options) {
  if (!altitude || !altitude->above_sea_m) return locate(map, features, prior, options);
  const double above_sea_m = *altitude->above_sea_m;
  const auto agl = agl_above(map, search_region(map, prior, options).box, above_sea_m);
  if (!agl) {
    return unknown_height(map,
                          "the map does not know how high the ground is that is searched, or it is above the UAV: "
                          "check its height above the sea, or give that above ground");
  }
  if (agl->scale_range() > kMaxScaleRange) {
    return unknown_height(map, fmt::format("by the heights of the ground that is searched the UAV may be {:.0f} to "
                                           "{:.0f} m above it, and see it in too many sizes: give a smaller prior, or "
                                           "the height above ground",
                                           agl->lowest_m, agl->highest_m));
  }
  FixOptions sized = options;
  if (agl->scale_range() > kNoRange) {
    sized.search.scale_range = std::min(kMaxScaleRange, together(options.search.scale_range, agl->scale_range()));
  }
  const double agl_m = agl->middle_m();
  if (options.own_frame) sized.own_frame = seen_from(*options.own_frame, *altitude, agl_m);
  Fix fix = locate(map, seen_from(features, *altitude, agl_m), prior, sized);
  relate_to_ground(fix, map, above_sea_m, agl_m);
  if (claims_a_place(fix)) require_right_size(fix, options.search.scale_range);
  return fix;
}

}  // namespace roadfix
