#include "core/locate/match_poses.hpp"

#include <algorithm>
#include <cmath>
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

/// A pose on the map's lattice.
struct GridQuery {
  std::size_t index = 0;  ///< in the list of poses
  LatticeIndex cell;
  GridGeometry::CellPosition offset;  ///< from the cell's centre
  Angle heading;
};

/// Calls use(query) for each of the poses but those off the map, since nothing is observed there.
template <typename Use>
void for_each_on_map(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses, Use use) {
  const double cell_m = features.cell_m;
  const GridBox wide = grown(map.extent, footprint_reach(features) * cell_m);
  PointProjector project(map.zone);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto projected = project(poses[i].position);
    if (!projected || !wide.contains(projected->point)) continue;
    const GridPoint at = projected->point;
    const double col = std::floor(at.east_m / cell_m);
    const double row = std::floor(-at.north_m / cell_m);
    use(GridQuery{i,
                  {static_cast<int>(col), static_cast<int>(row)},
                  {at.east_m / cell_m - col - 0.5, -at.north_m / cell_m - row - 0.5},
                  poses[i].heading - projected->convergence});
  }
}

MatchSums sums_at(const MapView& map, const FeatureMap& features, const GridQuery& query, int reach) {
  const int size = 2 * reach + 1;
  const GridGeometry window{features.cell_m, {query.cell.col - reach, query.cell.row - reach}, size, size};
  const MapPlane plane(map.read(window).cells, 0);
  const PlaneCell middle{reach, reach};
  MatchSums sums;
  match_sums(plane, footprint_at(features, query.heading, query.offset), std::span(&middle, 1), std::span(&sums, 1));
  return sums;
}

void match_exactly(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses,
                   const MatchOptions& options, std::span<MatchSums> sums) {
  std::vector<GridQuery> queries;
  for_each_on_map(map, features, poses, [&](const GridQuery& query) { queries.push_back(query); });
  const int reach = footprint_reach(features) + 1;  // a nadir off its cell's centre may need one more
  parallel_for(static_cast<int>(queries.size()), options.threads, [&](int i) {
    require_not_stopped(options.stop);
    const GridQuery& query = queries[static_cast<std::size_t>(i)];
    sums[query.index] = sums_at(map, features, query, reach);
  });
}

void match_in_bins(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses,
                   const MatchOptions& options, std::span<MatchSums> sums) {
  constexpr double kMaxBins = 1e6;
  const double wanted = std::ceil(2.0 * std::numbers::pi / options.heading_step.radians());
  const HeadingBins bins = HeadingBins(static_cast<int>(std::min(wanted, kMaxBins))).in_quarters();
  std::vector<BinnedPose> binned;
  binned.reserve(poses.size());
  for_each_on_map(map, features, poses, [&](const GridQuery& query) {
    const double turned = query.heading.compass_degrees() / 360.0 * bins.count();
    binned.push_back({query.cell, bins.wrapped(static_cast<int>(std::round(turned))), query.index});
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

}  // namespace roadfix
