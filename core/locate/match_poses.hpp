// Equations (5) to (7) at poses that the caller has: particles of a filter, candidates of another method.
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/geodesy/geo_pose.hpp"
#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"
#include "core/match/correlation.hpp"
#include "core/match/kernel.hpp"

namespace roadfix {

struct MatchOptions {
  /// 0: each pose exactly, with the feature map resampled to its heading and its place within the cell. Else headings
  /// are rounded to bins of this step and positions to cells: far faster for many poses.
  Angle heading_step;
  int threads = 1;
  std::stop_token stop;
};

/// One score per pose, in their order. For a pose off the map nothing is observed and rho is not defined. Throws
/// InvalidInput for positions that do not exist on Earth and for a feature map that cannot be used.
std::vector<MatchScore> match(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses,
                              const MatchOptions& options = {});

/// What equation (5) and other correlations follow from at one pose, exactly. `features` are in cells of the map or of
/// an overview (see in_cells_of()).
MatchSums sums_at(const MapView& map, const FeatureMap& features, const GridPose& pose);
/// The same at poses that lie so many whole cells from that one, in their order.
std::vector<MatchSums> sums_beside(const MapView& map, const FeatureMap& features, const GridPose& pose,
                                   std::span<const PlaneCell> offsets);
/// Equation (5) of that; nullopt where it is not defined.
std::optional<double> rho_at(const MapView& map, const FeatureMap& features, const GridPose& pose);

}  // namespace roadfix
