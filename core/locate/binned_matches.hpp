// The sums of equation (5) at many poses on the lattice: the map is read once for those that are near each other, and
// the feature map is turned once to each heading.
#pragma once

#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

#include "core/grid/feature_map.hpp"
#include "core/locate/map_view.hpp"
#include "core/match/correlation.hpp"
#include "core/match/heading_bins.hpp"

namespace roadfix {

struct BinnedPose {
  LatticeIndex cell;  ///< of the nadir, in cells of the feature map's size
  int bin = 0;        ///< of the heading, wrapped
  std::size_t index = 0;
};

/// sums[pose.index] of each pose (its bin within 0 to bins.count() - 1, a multiple of four: in_quarters()); the others
/// are left as they are. `features` are in cells of the map or of an overview (see in_cells_of()). Throws Interrupted
/// when asked to stop.
void match_binned(const MapView& map, const FeatureMap& features, const HeadingBins& bins,
                  std::vector<BinnedPose> poses, int threads, const std::stop_token& stop, std::span<MatchSums> sums);

}  // namespace roadfix
