#include "core/track/particle_matches.hpp"

#include <utility>

#include "core/grid/resample.hpp"
#include "core/locate/binned_matches.hpp"
#include "core/match/footprint.hpp"
#include "core/match/scales.hpp"

namespace roadfix {
namespace {

constexpr double kBinCells = 2.0;  // by which the edge of the footprint moves from one bin to the next

}  // namespace

ParticleMatches match_particles(const MapView& map, const FeatureMap& features, const Particles& particles,
                                double scale_range, int threads, const std::stop_token& stop) {
  const Particles& p = particles;
  const double cell_m = features.cell_m;
  const double radius_m = footprint_reach(features) * cell_m;
  const HeadingBins bins = HeadingBins::for_footprint(radius_m, kBinCells * cell_m).in_quarters();
  const Scales scales = Scales::for_footprint(radius_m, kBinCells * cell_m, scale_range);
  ParticleMatches matches{std::vector<MatchSums>(p.size()), std::vector<double>(p.size(), 1.0)};
  std::vector<std::vector<BinnedPose>> of_scale(static_cast<std::size_t>(scales.count()));
  for (auto& poses : of_scale) poses.reserve(p.size() / of_scale.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.weight[i] <= 0.0) continue;
    const LatticeIndex cell = lattice_index({p.east_m[i], p.north_m[i]}, cell_m);
    const int scale = scales.nearest(p.log_scale[i]);
    matches.scales[i] = scales.factor(scale);
    of_scale[static_cast<std::size_t>(scale + scales.reach())].push_back(
        {cell, bins.nearest(Angle::radians(p.heading_rad[i])), i});
  }
  for (std::size_t k = 0; k < of_scale.size(); ++k) {
    if (of_scale[k].empty()) continue;
    const double factor = scales.factor(static_cast<int>(k) - scales.reach());
    match_binned(map, resampled(features, cell_m, factor), bins, std::move(of_scale[k]), threads, stop, matches.sums);
  }
  return matches;
}

}  // namespace roadfix
