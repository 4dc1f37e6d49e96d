#include "core/locate/match_poses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "core/geodesy/local_projection.hpp"
#include "core/locate/binned_matches.hpp"
#include "core/locate/prepare.hpp"
#include "core/match/deadline.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// Calls use(index, pose) for each of the poses but those off the map, since nothing is observed there.
template <typename Use>
void for_each_on_map(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses, Use use) {
  const GridBox wide = grown(map.extent, footprint_reach(features) * features.cell_m);
  PointProjector project(map.zone);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto projected = project(poses[i].position);
    if (!projected || !wide.contains(projected->point)) continue;
    use(i, GridPose{projected->point, poses[i].heading - projected->convergence});
  }
}

void match_exactly(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses,
                   const MatchOptions& options, std::span<MatchSums> sums) {
  std::vector<std::pair<std::size_t, GridPose>> on_map;
  for_each_on_map(map, features, poses, [&](std::size_t i, const GridPose& pose) { on_map.emplace_back(i, pose); });
  parallel_for(static_cast<int>(on_map.size()), options.threads, [&](int task) {
    require_not_stopped(options.stop);
    const auto& [i, pose] = on_map[static_cast<std::size_t>(task)];
    sums[i] = sums_at(map, features, pose);
  });
}

void match_in_bins(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses,
                   const MatchOptions& options, std::span<MatchSums> sums) {
  constexpr double kMaxBins = 1e6;
  const double wanted = std::ceil(2.0 * std::numbers::pi / options.heading_step.radians());
  const HeadingBins bins = HeadingBins(static_cast<int>(std::min(wanted, kMaxBins))).in_quarters();
  std::vector<BinnedPose> binned;
  binned.reserve(poses.size());
  for_each_on_map(map, features, poses, [&](std::size_t i, const GridPose& pose) {
    const double turned = pose.heading.compass_degrees() / 360.0 * bins.count();
    const int bin = bins.wrapped(static_cast<int>(std::round(turned)));
    binned.push_back({lattice_index(pose.position, features.cell_m), bin, i});
  });
  match_binned(map, features, bins, std::move(binned), options.threads, options.stop, sums);
}

}  // namespace

std::vector<MatchScore> match(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses,
                              const MatchOptions& options) {
  const FeatureMap cells = in_cells_of(map, features);
  std::vector<MatchSums> sums(poses.size());
  if (options.heading_step.radians() > 0.0) {
    match_in_bins(map, cells, poses, options, sums);
  } else {
    match_exactly(map, cells, poses, options, sums);
  }
  std::vector<MatchScore> scores;
  scores.reserve(sums.size());
  for (const MatchSums& s : sums) scores.push_back({rho(s), s.n});
  return scores;
}

MatchSums sums_at(const MapView& map, const FeatureMap& features, const GridPose& pose) {
  return sums_beside(map, features, pose, std::array{PlaneCell{}}).front();
}

std::vector<MatchSums> sums_beside(const MapView& map, const FeatureMap& features, const GridPose& pose,
                                   std::span<const PlaneCell> offsets) {
  const LatticeIndex cell = lattice_index(pose.position, features.cell_m);
  const PackedFootprint footprint = footprint_at(features, pose.heading,
                                                 {pose.position.east_m / features.cell_m - cell.col - 0.5,
                                                  -pose.position.north_m / features.cell_m - cell.row - 0.5});
  int farthest = 0;
  for (const PlaneCell& offset : offsets) farthest = std::max({farthest, std::abs(offset.col), std::abs(offset.row)});
  const int reach = footprint.reach() + farthest;
  const GridGeometry window{features.cell_m, {cell.col - reach, cell.row - reach}, 2 * reach + 1, 2 * reach + 1};
  const MapPlane plane(map.read(window).cells);
  std::vector<PlaneCell> places;
  for (const PlaneCell& offset : offsets) places.push_back({reach + offset.col, reach + offset.row});
  std::vector<MatchSums> sums(places.size());
  match_sums(plane, footprint, places, sums);
  return sums;
}

std::optional<double> rho_at(const MapView& map, const FeatureMap& features, const GridPose& pose) {
  return rho(sums_at(map, features, pose));
}

}  // namespace roadfix
