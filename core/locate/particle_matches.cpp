#include "core/locate/particle_matches.hpp"

#include <cmath>
#include <utility>

#include "core/locate/binned_matches.hpp"
#include "core/match/footprint.hpp"

namespace roadfix {

std::vector<MatchSums> match_particles(const MapView& map, const FeatureMap& features, const Particles& particles,
                                       int threads, const std::stop_token& stop) {
  const Particles& p = particles;
  const double cell_m = features.cell_m;
  const HeadingBins bins = HeadingBins::for_footprint(footprint_reach(features) * cell_m, 2.0 * cell_m).in_quarters();
  std::vector<BinnedPose> poses;
  poses.reserve(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.weight[i] <= 0.0) continue;
    const LatticeIndex cell{static_cast<int>(std::floor(p.east_m[i] / cell_m)),
                            static_cast<int>(std::floor(-p.north_m[i] / cell_m))};
    const double turned = p.heading_rad[i] / bins.step().radians();
    poses.push_back({cell, bins.wrapped(static_cast<int>(std::lround(turned))), i});
  }
  std::vector<MatchSums> sums(p.size());
  match_binned(map, features, bins, std::move(poses), threads, stop, sums);
  return sums;
}

}  // namespace roadfix
