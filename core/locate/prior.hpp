// What is known before a search of where a vehicle may be, and the region of the map that this leaves.
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

/// The part of the map within the prior, and the grid headings that are within its range anywhere in that part. Throws
/// InvalidInput if nothing is left ("prior-outside-map", "prior-contradictory", "map-unobserved") and for numbers out
/// of range ("parameter-out-of-range").
PoseRegion region_of(const MapView& map, const Prior& prior);

}  // namespace roadfix
