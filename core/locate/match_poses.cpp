#include "core/locate/match_poses.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/locate/prepare.hpp"
#include "core/match/coarse_scan.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/work.hpp"

namespace roadfix {
namespace {

constexpr int kBlockCells = 1024;  // poses whose nadirs share such a block share one read of the map

struct GridQuery {
  std::size_t index = 0;  ///< in the list of poses
  LatticeIndex cell;
  GridGeometry::CellPosition offset;  ///< from the cell's centre
  Angle heading;
};

using BlockKey = std::tuple<int, int>;

class Matcher {
 public:
  Matcher(const MapView& map, const FeatureMap& features, const MatchOptions& options)
      : map_(map), options_(options), features_(in_cells_of(map, features)), reach_(footprint_reach(features_)) {}

  std::vector<MatchScore> run(std::span<const GeoPose> poses) {
    std::vector<MatchScore> scores(poses.size());
    for (const auto& [block, queries] : blocks_of(poses)) score_block(block, queries, scores);
    return scores;
  }

 private:
  /// Poses off the map are in no block: nothing is observed there.
  std::map<BlockKey, std::vector<GridQuery>> blocks_of(std::span<const GeoPose> poses) const {
    const double cell_m = features_.cell_m;
    const double reach_m = reach_ * cell_m;
    const GridBox wide{{map_.extent.min.east_m - reach_m, map_.extent.min.north_m - reach_m},
                       {map_.extent.max.east_m + reach_m, map_.extent.max.north_m + reach_m}};
    std::map<BlockKey, std::vector<GridQuery>> blocks;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto projected = map_.zone.project_if_defined(poses[i].position);
      if (!projected || !wide.contains(*projected)) continue;
      const GridPoint at = *projected;
      const double col = std::floor(at.east_m / cell_m);
      const double row = std::floor(-at.north_m / cell_m);
      GridQuery query{i, {static_cast<int>(col), static_cast<int>(row)}, {}, {}};
      query.offset = {at.east_m / cell_m - col - 0.5, -at.north_m / cell_m - row - 0.5};
      query.heading = map_.zone.grid_from_true(poses[i].heading, at);
      const auto block = [](double cell) { return static_cast<int>(std::floor(cell / kBlockCells)); };
      blocks[{block(col), block(row)}].push_back(query);
    }
    return blocks;
  }

  void score_block(const BlockKey& block, const std::vector<GridQuery>& queries,
                   std::vector<MatchScore>& scores) const {
    const auto [block_col, block_row] = block;
    const LatticeIndex first{block_col * kBlockCells - reach_, block_row * kBlockCells - reach_};
    const int size = kBlockCells + 2 * reach_;
    const MapPlane plane(map_.read({features_.cell_m, first, size, size}).cells, 0);
    const auto place = [&](const GridQuery& query) {
      return PlaneCell{query.cell.col - first.col, query.cell.row - first.row};
    };
    if (options_.heading_step.radians() > 0.0) {
      score_by_bins(plane, queries, place, scores);
      return;
    }
    const Deadline deadline(options_.stop, {});
    parallel_for(static_cast<int>(queries.size()), options_.threads, [&](int i) {
      deadline.check();
      const GridQuery& query = queries[static_cast<std::size_t>(i)];
      const Footprint footprint = footprint_at(features_, query.heading, query.offset);
      const PlaneCell at = place(query);
      MatchSums sums;
      match_sums(plane, footprint, std::span(&at, 1), std::span(&sums, 1));
      scores[query.index] = {rho(sums), sums.n};
    });
  }

  template <typename Place>
  void score_by_bins(const MapPlane& plane, const std::vector<GridQuery>& queries, Place place,
                     std::vector<MatchScore>& scores) const {
    const double turn = 2.0 * std::numbers::pi;
    const double bins = std::max(1.0, std::ceil(turn / options_.heading_step.radians()));
    std::map<int, std::vector<const GridQuery*>> members;
    for (const GridQuery& query : queries) {
      const double turned = query.heading.compass_degrees() / 360.0 * bins;
      members[static_cast<int>(std::fmod(std::round(turned), bins))].push_back(&query);
    }
    std::vector<std::pair<int, std::vector<const GridQuery*>>> tasks(members.begin(), members.end());
    const Deadline deadline(options_.stop, {});
    parallel_for(static_cast<int>(tasks.size()), options_.threads, [&](int t) {
      deadline.check();
      const auto& [bin, poses] = tasks[static_cast<std::size_t>(t)];
      const Footprint footprint = footprint_at(features_, Angle::radians(turn * bin / bins));
      std::vector<PlaneCell> places;
      for (const GridQuery* query : poses) places.push_back(place(*query));
      std::vector<MatchSums> sums(places.size());
      match_sums(plane, footprint, places, sums);
      for (std::size_t i = 0; i < poses.size(); ++i) scores[poses[i]->index] = {rho(sums[i]), sums[i].n};
    });
  }

  const MapView& map_;
  const MatchOptions& options_;
  FeatureMap features_;
  int reach_;
};

}  // namespace

std::vector<MatchScore> match(const MapView& map, const FeatureMap& features, std::span<const GeoPose> poses,
                              const MatchOptions& options) {
  return Matcher(map, features, options).run(poses);
}

}  // namespace roadfix
