#include "core/search/search_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/grid/resample.hpp"

namespace roadfix {
namespace {

// Streets of a town blur into each other beyond this.
constexpr double kCoarsestCellM = 8.0;
constexpr double kHugeFootprintM = 1500.0;  // side of a square as large as the ground that was seen

/// When the scan may have cells of up to this size: all of the conditions hold.
struct ScanCells {
  double coarsest_m;
  double seen_m = 0.0;      ///< at least, as kHugeFootprintM
  double side_cells = 0.0;  ///< of the footprint's longer side, at least
  double km2 = 0.0;         ///< of the region, times the sizes of the ground that are searched, at least
};

// Cells of 16 m cost an eighth of those of 8 m, with several sizes of the ground a sixteenth. They serve as well where
// more ground was seen and more candidates are followed, and with less where finer cells would take long. Footprints of
// kilometres tell places apart more surely, in coarser cells still.
constexpr std::array<ScanCells, 4> kScanCells{{{.coarsest_m = kCoarsestCellM, .side_cells = 32.0},
                                               {.coarsest_m = 16.0, .side_cells = 24.0, .km2 = 30.0},
                                               {.coarsest_m = 16.0, .seen_m = 480.0},
                                               {.coarsest_m = 32.0, .seen_m = kHugeFootprintM}}};

constexpr int kMostFootprintCells = 512;  // across the ground that was seen, on the finest level

// Cells of a proof, at most, and across a footprint, at least. They may be coarser than the map's: roads are as wide.
constexpr double kProofCellM = 4.0;
constexpr int kProofFootprintCells = 64;

// Candidates that are followed from the scan. What chance gives is estimated from them: if they are few for so much
// ground, one that fits by chance looks as if nothing else did.
constexpr double kCandidatesPerKm2 = 32.0;
constexpr double kFewestCandidates = 256.0;
constexpr double kMostCandidates = 4096.0;
constexpr double kCandidatesOfCoarser = 4.0;  // per candidate of the next level, if the scan is coarser than 8 m

int coarse_level(double finest_cell_m, double side_m, double seen_m, double km2_times_sizes) {
  const auto may_have = [&](double cell_m) {
    return std::ranges::any_of(kScanCells, [&](const ScanCells& allowed) {
      return cell_m <= allowed.coarsest_m && seen_m >= allowed.seen_m && side_m / cell_m >= allowed.side_cells &&
             km2_times_sizes >= allowed.km2;
    });
  };
  int level = 0;
  while (may_have(std::ldexp(finest_cell_m, level + 1))) ++level;
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

/// How far the footprint reaches from the nadir, about which headings turn it, along its longer side; at least as far
/// as from a nadir in its middle.
double radius_of(const FeatureMap& features) {
  return std::max(0.5 * features.side_m(), features.cell_m * features.off_nadir_cells());
}

}  // namespace

SearchLevels::SearchLevels(const GridReader& read, double finest_cell_m, const FeatureMap& features,
                           const PoseRegion& region, const SearchOptions& options)
    : region_(region), side_m_(features.side_m()), seen_m_(side_seen_m(features)) {
  const double radius_m = radius_of(features);
  const int sizes = Scales::for_footprint(radius_m, kCoarsestCellM, options.scale_range).count();
  const int coarsest = coarse_level(finest_cell_m, side_m_, seen_m_, region.area_km2() * sizes);
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

std::size_t SearchLevels::candidates_followed(int index) const {
  const bool coarser = coarse().cell_m() > kCoarsestCellM;
  const double most = coarser ? kMostCandidates / kCandidatesOfCoarser : kMostCandidates;
  const double cost_of_one = std::max(1.0, seen_m_ * seen_m_ / (kHugeFootprintM * kHugeFootprintM));
  const double wanted = std::clamp(kCandidatesPerKm2 * region_.area_km2(), kFewestCandidates, most) / cost_of_one;
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

std::vector<LatticePose> SearchLevels::distinct(std::vector<LatticePose> poses, const Level& level,
                                                const PoseSpacing& spacing, std::size_t keep) const {
  std::ranges::stable_sort(poses, std::ranges::greater{}, &LatticePose::score);
  const int bins_apart = spacing.coarse_bins * (level.bins.count() / coarse().bins.count());
  const double apart_cells = spacing.metres / level.cell_m();
  std::vector<LatticePose> kept;
  const PoseRegion within = widened(region_, level);
  const PoseRegion nearly = region_.grown(0.0, kHeadingsBeyond);
  const auto side_of = [&](const GridPose& pose) -> std::size_t {
    if (within.contains(pose)) return 0;
    return nearly.contains(pose.heading) ? 1 : 2;
  };
  std::array<std::size_t, 3> count{};
  for (const LatticePose& pose : poses) {
    std::size_t& same_side = count[side_of(level.pose_of(pose))];
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

std::vector<LatticePose> SearchLevels::distinct_candidates(std::vector<LatticePose> poses, const Level& level,
                                                           std::size_t keep) const {
  return distinct(std::move(poses), level, {kCandidatesApartCells * coarse().cell_m(), kCandidatesApartBins}, keep);
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
