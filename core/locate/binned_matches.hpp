// The sums of equation (5) at many poses on the lattice: the map is read once for all that are close to each other, and
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
  LatticeIndex cell;      ///< the cell below the vehicle, on the lattice of the feature map's cell size
  int bin = 0;            ///< the heading, as one of the bins from 0 to HeadingBins::count() - 1
  std::size_t index = 0;  ///< where the sums of this pose go
};

/// Writes the sums of each pose to sums[pose.index] and leaves all other elements as they are. The number of bins must
/// be a multiple of four (see in_quarters()). `features` are in cells of the map or of an overview (see in_cells_of()).
/// Throws Interrupted when asked to stop.
void match_binned(const MapView& map, const FeatureMap& features, const HeadingBins& bins,
                  std::vector<BinnedPose> poses, int threads, const std::stop_token& stop, std::span<MatchSums> sums);

}  // namespace roadfix
