#include "core/search/search_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/grid/resample.hpp"

namespace roadfix {
namespace {

// Streets of a town blur into each other beyond 8 m. A scan in cells of 16 m costs an eighth, one over sizes of the
// ground a sixteenth: it serves as well where enough ground was seen and more candidates are followed, and with less
// where finer cells would take long.
constexpr double kCoarsestCellM = 8.0;
constexpr int kFootprintCells = 32;  // that the coarse level keeps at least across a footprint
constexpr double kCoarsestCellOfLargeM = 16.0;
constexpr double kLargeKm2 = 30.0;          // of a region, times the sizes
constexpr int kFootprintCellsOfLarge = 24;  // likewise
constexpr double kCoarsestCellOfBroadM = 16.0;
constexpr double kBroadM = 480.0;  // side of a square as large as what was seen
// What lies where in a footprint of kilometres is known from coarser cells still, and tells places apart more surely.
constexpr double kCoarsestCellOfWideM = 32.0;
constexpr double kWideM = 1500.0;  // likewise

constexpr int kMostFootprintCells = 512;  // across what was seen of a footprint, on the finest level

// Of a proof, which may be given in coarser cells than the map's: roads are hardly wider.
constexpr double kProofCellM = 4.0;
constexpr int kProofFootprintCells = 64;  // across a footprint at least

// Followed from the coarse level. What is known of chance comes from the places that are followed: where they are few
// for the ground, the one of them that happens to fit looks as if no other did.
constexpr double kCandidatesPerKm2 = 32.0;
constexpr double kFewestCandidates = 256.0;
constexpr double kMostCandidates = 4096.0;
constexpr double kCandidatesOfCoarser = 4.0;  // for each that is followed from the next level, of a scan beyond 8 m

int coarse_level(double finest_cell_m, double side_m, double seen_m, double area_km2, int sizes) {
  const bool large = area_km2 * sizes >= kLargeKm2;
  const auto fits = [&](double cell_m) {
    const double across = side_m / cell_m;
    return (cell_m <= kCoarsestCellM && across >= kFootprintCells) ||
           (cell_m <= kCoarsestCellOfLargeM && large && across >= kFootprintCellsOfLarge) ||
           (cell_m <= kCoarsestCellOfBroadM && seen_m >= kBroadM) ||
           (cell_m <= kCoarsestCellOfWideM && seen_m >= kWideM);
  };
  int level = 0;
  while (fits(std::ldexp(finest_cell_m, level + 1))) ++level;
  return level;
}

/// More cells tell places apart no better, and each level takes four times as long as the one above.
int finest_level(double finest_cell_m, double seen_m, int coarsest) {
  int level = 0;
  while (level < coarsest && seen_m / std::ldexp(finest_cell_m, level) > kMostFootprintCells) ++level;
  return level;
}

/// Of a square as large as the ground that was seen.
double side_seen_m(const FeatureMap& features) {
  return features.cell_m * std::sqrt(static_cast<double>(features.cells.observed_count()));
}

/// From the nadir, about which headings turn the footprint, to what lies farthest along its longer side; for a nadir
/// within the footprint that of one in its middle.
double radius_of(const FeatureMap& features) {
  return std::max(0.5 * features.side_m(), features.cell_m * features.off_nadir_cells());
}

}  // namespace

SearchLevels::SearchLevels(const GridReader& read, double finest_cell_m, const FeatureMap& features,
                           const PoseRegion& region, const SearchOptions& options)
    : region_(region), side_m_(features.side_m()), seen_m_(side_seen_m(features)) {
  const double radius_m = radius_of(features);
  const int sizes = Scales::for_footprint(radius_m, kCoarsestCellM, options.scale_range).count();
  const int coarsest = coarse_level(finest_cell_m, side_m_, seen_m_, region.area_km2(), sizes);
  const double coarse_cell_m = std::ldexp(finest_cell_m, coarsest);
  const Scales scales = Scales::for_footprint(radius_m, coarse_cell_m, options.scale_range);
  const HeadingBins bins = HeadingBins::for_footprint(radius_m, coarse_cell_m);
  finest_ = finest_level(finest_cell_m, seen_m_, coarsest);
  for (int k = finest_; k <= coarsest; ++k) {
    const double cell_m = std::ldexp(finest_cell_m, k);
    levels_.push_back({read, features, LevelFeatures(resampled(features, cell_m)),
                       HeadingBins(bins.count() << (coarsest - k)), scales.finer(1 << (coarsest - k)),
                       options.threads});
  }
}

std::size_t SearchLevels::followed(int index) const {
  const bool coarser = coarse().cell_m() > kCoarsestCellM;
  const double most = coarser ? kMostCandidates / kCandidatesOfCoarser : kMostCandidates;
  const double cost = std::max(1.0, seen_m_ * seen_m_ / (kWideM * kWideM));  // of following one
  const double wanted = std::clamp(kCandidatesPerKm2 * region_.area_km2(), kFewestCandidates, most) / cost;
  if (index == coarsest()) {
    return static_cast<std::size_t>(std::max((coarser ? kCandidatesOfCoarser : 1.0) * wanted, kFewestCandidates));
  }
  if (coarser && index + 1 == coarsest()) return std::max(kSurvivors, static_cast<std::size_t>(wanted));
  return kSurvivors;
}

int SearchLevels::proof_level() const {
  int level = 0;
  for (int k = 1; k <= coarsest(); ++k) {
    const double cell_m = at(k).cell_m();
    if (cell_m <= kProofCellM && side_m_ / cell_m >= kProofFootprintCells) level = k;
  }
  return level;
}

int SearchLevels::spread_level() const {
  int level = coarsest();
  while (level > 0 && at(level).cell_m() > kCoarsestCellM) --level;
  return level;
}

PoseRegion SearchLevels::widened(const PoseRegion& region, const Level& level) {
  constexpr double kHalfDiagonalCells = 0.71;
  return region.grown(kHalfDiagonalCells * level.cell_m(), level.bins.step());
}

bool SearchLevels::within_region(const Level& level, const LatticePose& pose) const {
  return widened(region_, level).contains(level.pose_of(pose));
}

std::vector<LatticePose> SearchLevels::distinct(std::vector<LatticePose> poses, const Level& level, double apart_m,
                                                int coarse_bins_apart, std::size_t keep) const {
  std::ranges::stable_sort(poses, std::ranges::greater{}, &LatticePose::score);
  const int bins_apart = coarse_bins_apart * (level.bins.count() / coarse().bins.count());
  const double apart_cells = apart_m / level.cell_m();
  std::vector<LatticePose> kept;
  std::array<std::size_t, 2> count{};
  for (const LatticePose& pose : poses) {
    std::size_t& same_side = count[within_region(level, pose) ? 0 : 1];
    if (pose.score <= 0.0 || same_side >= keep) continue;
    const bool known = std::ranges::any_of(kept, [&](const LatticePose& other) {
      const double east = pose.cell.col - other.cell.col;
      const double south = pose.cell.row - other.cell.row;
      return east * east + south * south <= apart_cells * apart_cells &&
             level.bins.distance(pose.bin, other.bin) <= bins_apart;
    });
    if (known) continue;
    kept.push_back(pose);
    ++same_side;
  }
  return kept;
}

std::vector<LatticePose> SearchLevels::apart(std::vector<LatticePose> poses, const Level& level,
                                             std::size_t keep) const {
  return distinct(std::move(poses), level, kCandidatesApartCells * coarse().cell_m(), kCandidatesApartBins, keep);
}

std::vector<int> bins_within(const HeadingBins& bins, const PoseRegion& region) {
  std::vector<int> within;
  for (int bin = 0; bin < bins.count(); ++bin) {
    if (region.contains(bins.heading(bin))) within.push_back(bin);
  }
  return within;
}

std::function<bool(int, int)> cells_within(const GridGeometry& positions, const PoseRegion& region) {
  return [positions, region](int col, int row) { return region.contains(positions.cell_center(col, row)); };
}

void descend(std::vector<LatticePose>& candidates) {
  for (LatticePose& pose : candidates) {
    pose.cell = {2 * pose.cell.col, 2 * pose.cell.row};
    pose.bin *= 2;
    pose.scale_step *= 2;
  }
}

}  // namespace roadfix
