#include "core/locate/particle_matches.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "core/match/coarse_scan.hpp"
#include "core/match/footprint.hpp"
#include "core/match/heading_bins.hpp"
#include "core/match/kernel.hpp"
#include "core/match/work.hpp"

namespace roadfix {
namespace {

constexpr int kBlockCells = 1024;  // particles in such a block share one read of the map

struct Place {
  int block_col = 0;
  int block_row = 0;
  int bin = 0;
  LatticeIndex cell;
  std::size_t particle = 0;

  bool same_block(const Place& other) const { return block_col == other.block_col && block_row == other.block_row; }
};

std::vector<Place> places_of(const Particles& p, double cell_m, const HeadingBins& bins) {
  std::vector<Place> places;
  places.reserve(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.weight[i] <= 0.0) continue;
    const auto col = static_cast<int>(std::floor(p.east_m[i] / cell_m));
    const auto row = static_cast<int>(std::floor(-p.north_m[i] / cell_m));
    const double turned = p.heading_rad[i] / bins.step().radians();
    const auto block = [](int cell) { return static_cast<int>(std::floor(static_cast<double>(cell) / kBlockCells)); };
    places.push_back({block(col), block(row), bins.wrapped(static_cast<int>(std::lround(turned))), {col, row}, i});
  }
  std::ranges::sort(places, [](const Place& a, const Place& b) {
    return std::tie(a.block_col, a.block_row, a.bin, a.particle) <
           std::tie(b.block_col, b.block_row, b.bin, b.particle);
  });
  return places;
}

/// Ends of the runs of equal neighbours.
template <typename Same>
std::vector<std::span<const Place>> runs(std::span<const Place> places, Same same) {
  std::vector<std::span<const Place>> result;
  for (std::size_t first = 0; first < places.size();) {
    std::size_t last = first + 1;
    while (last < places.size() && same(places[first], places[last])) ++last;
    result.push_back(places.subspan(first, last - first));
    first = last;
  }
  return result;
}

GridGeometry around(std::span<const Place> places, double cell_m, int reach) {
  LatticeIndex low = places.front().cell;
  LatticeIndex high = low;
  for (const Place& place : places) {
    low = {std::min(low.col, place.cell.col), std::min(low.row, place.cell.row)};
    high = {std::max(high.col, place.cell.col), std::max(high.row, place.cell.row)};
  }
  return {cell_m,
          {low.col - reach, low.row - reach},
          high.col - low.col + 1 + 2 * reach,
          high.row - low.row + 1 + 2 * reach};
}

}  // namespace

std::vector<MatchSums> match_particles(const MapView& map, const FeatureMap& features, const Particles& particles,
                                       int threads, const std::stop_token& stop) {
  const double cell_m = features.cell_m;
  const int reach = footprint_reach(features);
  const HeadingBins bins = HeadingBins::for_footprint(reach * cell_m, 2.0 * cell_m);
  const std::vector<Place> places = places_of(particles, cell_m, bins);
  std::vector<MatchSums> sums(particles.size());
  const Deadline deadline(stop, {});
  for (const auto block : runs(places, [](const Place&a, const Place&b) { return a.same_block(b); })) {
    const GridGeometry window = around(block, cell_m, reach);
    const MapPlane plane(map.read(window).cells, 0);
    const auto by_bin = runs(block, [](const Place& a, const Place& b) { return a.bin == b.bin; });
    parallel_for(static_cast<int>(by_bin.size()), threads, [&](int task) {
      deadline.check();
      const auto members = by_bin[static_cast<std::size_t>(task)];
      const Footprint footprint = footprint_at(features, bins.heading(members.front().bin));
      std::vector<PlaneCell> cells;
      for (const Place& place : members) {
        cells.push_back({place.cell.col - window.origin.col, place.cell.row - window.origin.row});
      }
      std::vector<MatchSums> found(cells.size());
      match_sums(plane, footprint, cells, found);
      for (std::size_t k = 0; k < members.size(); ++k) sums[members[k].particle] = found[k];
    });
  }
  return sums;
}

}  // namespace roadfix
