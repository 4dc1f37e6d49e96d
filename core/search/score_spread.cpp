#include "core/search/score_spread.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/search/ground_around.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

// Scores differ more between places than between the headings of one place, so there are more places.
constexpr int kPlaces = 256;
constexpr int kHeadings = 16;
constexpr std::int64_t kFewestScores = 512;

/// The fractional part of i times an irrational number: evenly spread however many are taken, and out of step with
/// regular streets. Irrational numbers: the golden ratio and, for two dimensions, powers of the plastic number.
double spread_evenly(int i, double irrational) { return std::fmod((i + 0.5) * irrational, 1.0); }
constexpr double kGolden = 0.6180339887498949;
constexpr double kPlasticEast = 0.7548776662466927;
constexpr double kPlasticNorth = 0.5698402909980532;

std::vector<LatticePose> places_within(const Level& level, const PoseRegion& region) {
  std::vector<LatticePose> places;
  const GridPoint low = region.box.min;
  const GridPoint high = region.box.max;
  for (int i = 0; i < 2 * kPlaces && std::ssize(places) < kPlaces; ++i) {
    const GridPoint place{std::lerp(low.east_m, high.east_m, spread_evenly(i, kPlasticEast)),
                          std::lerp(low.north_m, high.north_m, spread_evenly(i, kPlasticNorth))};
    if (!region.contains(place)) continue;
    places.push_back({lattice_index(place, level.cell_m())});
  }
  return places;
}

struct Squares {
  double sum = 0.0;
  std::int64_t count = 0;
};

Squares squares_at(const Level& level, int bin, const GroundAround& ground, const std::vector<LatticePose>& places) {
  const PackedFootprint footprint = footprint_at(level.features.rotator, level.bins.heading(bin));
  std::vector<std::size_t> poses(places.size());
  std::iota(poses.begin(), poses.end(), 0);
  std::vector<LatticeIndex> cells;
  for (const LatticePose& place : places) cells.push_back(place.cell);
  std::vector<MatchSums> sums(cells.size());
  ground.match(footprint, 0, poses, cells, sums);
  Squares squares;
  for (const MatchSums& each : sums) {
    const double score = score_of(each, level.features.cells);
    if (score == 0.0) continue;
    squares.sum += score * score;
    ++squares.count;
  }
  return squares;
}

}  // namespace

std::optional<double> score_spread(const Level& level, const PoseRegion& region, const Deadline& deadline) {
  const std::vector<LatticePose> places = places_within(level, region);
  const GroundAround ground(level, {}, deadline, places);
  if (!ground.complete()) return std::nullopt;
  std::vector<Squares> of_heading(kHeadings);
  parallel_for(kHeadings, level.threads, [&](int i) {
    const int bin = static_cast<int>(spread_evenly(i, kGolden) * level.bins.count());
    of_heading[static_cast<std::size_t>(i)] = squares_at(level, bin, ground, places);
  });
  Squares all;
  for (const Squares& each : of_heading) {
    all.sum += each.sum;
    all.count += each.count;
  }
  if (all.count < kFewestScores) return std::nullopt;
  return std::sqrt(all.sum / static_cast<double>(all.count));
}

}  // namespace roadfix
