// Height above ground from the height above the sea, where the map knows the heights of its ground (MapView::terrain).
// Where the ground is not level, how large it is seen follows from where the vehicle is.
#pragma once

#include <optional>

#include "core/grid/feature_map.hpp"
#include "core/locate/fix.hpp"

namespace roadfix {

/// Fix::reason where the ground of the region leaves any size, or too many.
inline constexpr const char* kHeightUnknown = "height-unknown";

/// From where a feature map was seen.
struct Altitude {
  std::optional<double> above_sea_m;  ///< nullopt = agl_m is right
  /// The height above ground by which its cells were given a size, above 0.
  double agl_m = 0.0;
};

/// Heights above ground, above 0.
struct AglRange {
  double lowest_m = 0.0;
  double highest_m = 0.0;

  /// From which the ground of either end is wrong by the same factor.
  double middle_m() const;
  /// By how much it is: as SearchOptions::scale_range.
  double scale_range() const;
};

/// Of a vehicle anywhere above the known ground of the box, but for ground that is higher than the vehicle; nullopt
/// where there is none.
std::optional<AglRange> agl_above(const MapView& map, const GridBox& box, double above_sea_m);
/// Of the known ground of the box. Throws InvalidInput "terrain-missing" where the map knows no heights there.
HeightRange required_ground(const MapView& map, const GridBox& box);
/// The middle of agl_above(). Throws as required_ground(), and InvalidInput "below-ground" where all of the ground is
/// higher.
double required_agl_m(const MapView& map, const GridBox& box, double above_sea_m);

/// `features`, as from `agl_m` above ground.
FeatureMap seen_from(FeatureMap features, const Altitude& altitude, double agl_m);

/// locate(), where the size of what `features` and `options.own_frame` show follows from the altitude and the ground
/// below each place; nullopt, of it or its height above the sea = they have it.
///
/// The search goes over the sizes that this allows, beside those of options.search.scale_range, up to
/// kMaxScaleRange; FixMode::scale is relative to the size that follows. no_fix, where it may be any or too many sizes
/// (kHeightUnknown), and where the best place does not show the ground in the size that it should
/// ("terrain-contradicts"). Throws as locate().
Fix locate_from(const std::optional<Altitude>& altitude, const MapView& map, const FeatureMap& features,
                const Prior& prior, const FixOptions& options);

}  // namespace roadfix
