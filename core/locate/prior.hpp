// Where a vehicle may be, as it is known before a search, and what of a map that leaves.
#pragma once

#include <optional>

#include "core/geodesy/geo_box.hpp"
#include "core/locate/map_view.hpp"
#include "core/units/pose_region.hpp"

namespace roadfix {

struct GeoCircle {
  LatLon centre;
  double radius_m = 0.0;
};

/// True headings within +- half_width of centre.
struct HeadingRange {
  Angle centre;
  Angle half_width;
};

/// Nothing set = the whole map and all headings; circle and box intersect.
struct Prior {
  std::optional<GeoCircle> circle;
  std::optional<GeoBox> box;
  std::optional<HeadingRange> heading;
};

/// The part of the map that the prior leaves, and headings as far as they are within the range somewhere in it. Throws
/// InvalidInput where it leaves nothing ("prior-outside-map", "prior-contradictory", "map-unobserved"), and "prior-..."
/// for a prior that makes no sense.
PoseRegion region_of(const MapView& map, const Prior& prior);

}  // namespace roadfix
