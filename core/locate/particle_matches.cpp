#include "core/locate/particle_matches.hpp"

#include <cmath>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/locate/binned_matches.hpp"
#include "core/match/footprint.hpp"
#include "core/match/scales.hpp"

namespace roadfix {
namespace {

constexpr double kBinCells = 2.0;  // by which the edge of the footprint moves from one bin to the next

/// The particles with weight whose scale is nearest to that of the index.
std::vector<BinnedPose> poses_of(const Particles& p, const Scales& scales, int scale, const HeadingBins& bins,
                                 double cell_m) {
  std::vector<BinnedPose> poses;
  poses.reserve(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.weight[i] <= 0.0 || scales.nearest(p.log_scale[i]) != scale) continue;
    const LatticeIndex cell{static_cast<int>(std::floor(p.east_m[i] / cell_m)),
                            static_cast<int>(std::floor(-p.north_m[i] / cell_m))};
    const double turned = p.heading_rad[i] / bins.step().radians();
    poses.push_back({cell, bins.wrapped(static_cast<int>(std::lround(turned))), i});
  }
  return poses;
}

}  // namespace

ParticleMatches match_particles(const MapView& map, const FeatureMap& features, const Particles& particles,
                                double scale_range, int threads, const std::stop_token& stop) {
  const double cell_m = features.cell_m;
  const double radius_m = footprint_reach(features) * cell_m;
  const HeadingBins bins = HeadingBins::for_footprint(radius_m, kBinCells * cell_m).in_quarters();
  const Scales scales = Scales::for_footprint(radius_m, kBinCells * cell_m, scale_range);
  ParticleMatches matches{std::vector<MatchSums>(particles.size()), std::vector<double>(particles.size(), 1.0)};
  for (int scale = -scales.reach(); scale <= scales.reach(); ++scale) {
    std::vector<BinnedPose> poses = poses_of(particles, scales, scale, bins, cell_m);
    if (poses.empty()) continue;
    const double factor = scales.factor(scale);
    for (const BinnedPose& pose : poses) matches.scales[pose.index] = factor;
    match_binned(map, scaled(features, factor), bins, std::move(poses), threads, stop, matches.sums);
  }
  return matches;
}

}  // namespace roadfix
