// Feature maps of several frames, laid together along the odometry between them into one that sees more.
#pragma once

#include <span>

#include "core/grid/feature_map.hpp"
#include "core/grid/sampling.hpp"
#include "core/units/planar.hpp"

namespace roadfix {

struct PlacedFeatures {
  FeatureMap features;
  BodyOffset offset;      ///< of the UAV when it took this frame, from where it took the reference frame
  double higher_m = 0.0;  ///< it was than there, above ground or the sea, as these heights are told

  friend bool operator==(const PlacedFeatures&, const PlacedFeatures&) = default;
};

/// From cells of a feature map that was taken where the reference frame was, with this nadir and cells of that size, to
/// those of `part`.
Placement placement_in(const PlacedFeatures& part, GridGeometry::CellPosition nadir);

/// One feature map in the body frame of the reference, its nadir that of the reference and known as well as the least
/// known of all, since any of them may be what tells the place; just large enough for all parts. Where several parts
/// saw a cell it holds the mean of their log-odds: they err alike, so agreement is not counted twice. `parts` is not
/// empty. Throws InvalidInput ("cell-size-contradictory") unless all have cells of one size, and LimitExceeded
/// ("frames-too-far-apart") when the result would have more than `max_cells`.
FeatureMap combined(std::span<const PlacedFeatures> parts, double max_cells);

}  // namespace roadfix
