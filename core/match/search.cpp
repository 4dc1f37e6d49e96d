#include "core/match/search.hpp"

#include <algorithm>
#include <cmath>

#include "core/grid/resample.hpp"
#include "core/match/branch_and_bound.hpp"
#include "core/match/coarse_scan.hpp"
#include "core/match/peak.hpp"
#include "core/match/refine.hpp"

namespace roadfix {
namespace {

// Streets of a town blur into each other beyond 8 m: a large region is scanned in cells of 16 m all the same, since it
// costs an eighth, but then many more candidates are followed.
constexpr double kCoarsestCellM = 8.0;
constexpr double kCoarsestCellOfLargeM = 16.0;
constexpr double kLargeKm2 = 30.0;
constexpr int kFootprintCells = 32;         // that the coarse level keeps at least across a footprint
constexpr int kFootprintCellsOfLarge = 24;  // likewise, in a large region

constexpr double kProofCellM = 4.0;       // roads are hardly wider
constexpr int kProofFootprintCells = 64;  // likewise at least, where a proof is given in coarser cells than the map's

constexpr std::size_t kScanMaxima = 16384;
constexpr std::size_t kCandidates = 256;          // followed from the coarse level, or from 8 m
constexpr std::size_t kCandidatesOfLarge = 4096;  // followed from coarser cells
constexpr std::size_t kSurvivors = 96;            // followed from each finer level
constexpr double kScanTimeShare = 0.75;           // at most, if the time is limited: what it finds has to be followed
constexpr int kRivalsWanted = 1000;               // distinct places that a background is drawn from

double side_m(const FeatureMap& features) {
  return features.cell_m * std::max(features.cells.cols(), features.cells.rows());
}

int coarse_level(double finest_cell_m, const FeatureMap& features, const SearchRegion& region) {
  const bool large = region.area_km2() >= kLargeKm2;
  const auto fits = [&](double cell_m) {
    const double across = side_m(features) / cell_m;
    return (cell_m <= kCoarsestCellM && across >= kFootprintCells) ||
           (large && cell_m <= kCoarsestCellOfLargeM && across >= kFootprintCellsOfLarge);
  };
  int level = 0;
  while (fits(std::ldexp(finest_cell_m, level + 1))) ++level;
  return level;
}

GridBox grown(const GridBox& box, double by_m) {
  return {{box.min.east_m - by_m, box.min.north_m - by_m}, {box.max.east_m + by_m, box.max.north_m + by_m}};
}

SearchRegion grown(SearchRegion region, double by_m, Angle heading) {
  region.box = grown(region.box, by_m);
  if (region.circle) region.circle->radius_m += by_m;
  region.heading_half_width += heading;
  return region;
}

/// Everything that one search knows; `run` names the steps.
class Search {
 public:
  Search(const GridReader& read, double finest_cell_m, const FeatureMap& features, const SearchRegion& region,
         const SearchOptions& options)
      : read_(read),
        region_(region),
        options_(options),
        deadline_(options.stop, options.deadline),
        coarsest_(coarse_level(finest_cell_m, features, region)) {
    const double radius_m = 0.5 * side_m(features);
    const double coarse_cell_m = std::ldexp(finest_cell_m, coarsest_);
    const Scales scales = Scales::for_footprint(radius_m, coarse_cell_m, options.scale_range);
    for (int k = 0; k <= coarsest_; ++k) {
      const double cell_m = std::ldexp(finest_cell_m, k);
      const HeadingBins bins = HeadingBins::for_footprint(radius_m, coarse_cell_m);
      FeatureMap scaled = k == 0 && features.cell_m == cell_m ? features : resampled(features, cell_m);
      levels_.push_back({read, features, LevelFeatures(std::move(scaled), options.min_observed_share),
                         options.min_observed_share, HeadingBins(bins.count() << (coarsest_ - k)),
                         scales.finer(1 << (coarsest_ - k)), options.threads});
    }
    separation_m_ = std::max(2.5 * coarse().cell_m(), 0.1 * side_m(features));
    plan_scan();
  }

  SearchResult run() {
    SearchResult result;
    result.cell_m = levels_.front().cell_m();
    result.coarse_cell_m = coarse().cell_m();
    std::vector<LatticePose> candidates = scan(result);
    result.refined = refine(coarse(), 1, 1, deadline_, candidates);
    if (proof_level() == coarsest_) prove(coarsest_, candidates, result);
    for (int k = coarsest_ - 1; k >= 0; --k) {
      const Level& from = levels_[static_cast<std::size_t>(k + 1)];
      candidates = distinct(candidates, from, 2.5 * coarse().cell_m(), 2, followed(k + 1));
      descend(candidates);
      result.refined = refine(levels_[static_cast<std::size_t>(k)], 2, 2, deadline_, candidates) && result.refined;
      if (proof_level() == k) prove(k, candidates, result);
    }
    const Level& finest = levels_.front();
    candidates = distinct(candidates, finest, separation_m_, kDistinctBins, kSurvivors);
    rank(candidates, result);
    return result;
  }

 private:
  static constexpr int kDistinctBins = 3;  // of the coarse level

  const Level& coarse() const { return levels_.back(); }
  std::size_t followed(int level) const {
    const double cell_m = levels_[static_cast<std::size_t>(level)].cell_m();
    if (cell_m > kCoarsestCellM) return kCandidatesOfLarge;
    return level == coarsest_ || cell_m == kCoarsestCellM ? kCandidates : kSurvivors;
  }

  /// A small region holds too few places to tell what chance would give: its surroundings are scanned as well.
  void plan_scan() {
    scanned_ = region_;
    const double turns = region_.heading_half_width.degrees() / 180.0;
    const double places_per_m2 = coarse().bins.count() / (2.0 * kDistinctBins) / (separation_m_ * separation_m_);
    const double wanted_m2 = kRivalsWanted / places_per_m2;
    if (region_.area_km2() * 1e6 * std::min(turns, 1.0) >= wanted_m2) return;
    const double need = 0.5 * std::sqrt(wanted_m2);
    scanned_.circle.reset();
    const GridPoint centre{0.5 * (region_.box.min.east_m + region_.box.max.east_m),
                           0.5 * (region_.box.min.north_m + region_.box.max.north_m)};
    scanned_.box.min.east_m = std::min(region_.box.min.east_m, centre.east_m - need);
    scanned_.box.min.north_m = std::min(region_.box.min.north_m, centre.north_m - need);
    scanned_.box.max.east_m = std::max(region_.box.max.east_m, centre.east_m + need);
    scanned_.box.max.north_m = std::max(region_.box.max.north_m, centre.north_m + need);
    scanned_.heading_half_width = Angle::degrees(180.0);
  }

  /// Candidates at the coarse level, distinct and best first: those within the region and, where it was enlarged, as
  /// many from around it.
  std::vector<LatticePose> scan(SearchResult& result) {
    ScanRequest request;
    const double cell_m = coarse().cell_m();
    request.positions = GridGeometry::covering(scanned_.box, cell_m);
    request.bins = coarse().bins;
    const SearchRegion wide = grown(scanned_, 0.71 * cell_m, coarse().bins.step());
    for (int bin = 0; bin < request.bins.count(); ++bin) {
      if (wide.contains(request.bins.heading(bin))) request.headings.push_back(bin);
    }
    request.eligible = [&](int col, int row) { return wide.contains(request.positions.cell_center(col, row)); };
    request.min_observed_share = options_.min_observed_share;
    request.keep = kScanMaxima;
    request.threads = options_.threads;
    const int largest = coarse().scales.reach();
    const int reach = coarse().reach(largest);
    const GridGeometry& positions = request.positions;
    const GridGeometry window{cell_m,
                              {positions.origin.col - reach, positions.origin.row - reach},
                              positions.cols + 2 * reach,
                              positions.rows + 2 * reach};
    const int block = scan_block(coarse().features.map);
    const auto map = cached<ScanMap>(window, {reach, block}, [&] { return ScanMap(read_(window), reach, block); });
    const Deadline end = deadline_.after(kScanTimeShare);
    std::vector<LatticePose> inside;
    std::vector<LatticePose> outside;
    double squares = 0.0;
    result.scales = 2 * largest + 1;
    double shares = 0.0;
    for (int scale = -largest; scale <= largest; ++scale) {
      const ScanResult found = coarse_scan(*map, coarse().at_scale(scale).map, request, end);
      shares += found.share;
      result.background.poses += found.poses;
      squares += found.score_square_sum;
      for (const ScanPose& pose : found.maxima) {
        const LatticePose lattice{{positions.origin.col + pose.col, positions.origin.row + pose.row},
                                  pose.bin,
                                  static_cast<double>(pose.score),
                                  scale};
        (within_region(coarse(), lattice) ? inside : outside).push_back(lattice);
      }
    }
    result.scanned_share = shares / result.scales;
    result.headings = static_cast<int>(request.headings.size());
    if (result.background.poses > 0) {
      result.background.sd = std::sqrt(squares / static_cast<double>(result.background.poses));
    }
    std::vector<LatticePose> candidates = distinct(inside, coarse(), 2.5 * cell_m, 2, followed(coarsest_));
    const std::vector<LatticePose> others = distinct(outside, coarse(), 2.5 * cell_m, 2, kCandidates);
    candidates.insert(candidates.end(), others.begin(), others.end());
    return candidates;
  }

  template <typename T, typename Build>
  std::shared_ptr<const T> cached(const GridGeometry& window, std::array<int, 2> parameters, Build build) const {
    if (!options_.cache) return std::make_shared<const T>(build());
    return options_.cache->get<T>(window, parameters, build);
  }

  int proof_level() const {
    int level = 0;
    for (int k = 1; k <= coarsest_; ++k) {
      const double cell_m = levels_[static_cast<std::size_t>(k)].cell_m();
      if (cell_m <= kProofCellM && side_m(levels_.front().features.map) / cell_m >= kProofFootprintCells) level = k;
    }
    return level;
  }

  /// Looks for poses of the region that are better than the best candidate, and adds them.
  void prove(int k, std::vector<LatticePose>& candidates, SearchResult& result) const {
    if (options_.proof_time.count() <= 0) return;
    const Level& level = levels_[static_cast<std::size_t>(k)];
    BoundedSearch bounded;
    bounded.bins = level.bins;
    for (int bin = 0; bin < level.bins.count(); ++bin) {
      if (region_.contains(level.bins.heading(bin))) bounded.headings.push_back(bin);
    }
    bounded.positions = GridGeometry::covering(region_.box, level.cell_m());
    bounded.eligible = [&](int col, int row) { return region_.contains(bounded.positions.cell_center(col, row)); };
    bounded.threads = options_.threads;
    for (const LatticePose& pose : candidates) {
      const GridPose at = level.pose_of(pose);
      if (region_.contains(at.position) && region_.contains(at.heading))
        bounded.known = std::max(bounded.known, pose.score);
    }
    const int largest = level.scales.reach();
    const int reach = level.reach(largest) + BoundMap::kFrame;
    const GridGeometry& positions = bounded.positions;
    const GridGeometry window{level.cell_m(),
                              {positions.origin.col - reach, positions.origin.row - reach},
                              positions.cols + 2 * reach,
                              positions.rows + 2 * reach};
    const auto map = cached<BoundMap>(window, {}, [&] { return BoundMap(level.read(window)); });
    bounded.map = map.get();
    // What follows the best pose to the finest cells needs the rest of the time.
    const auto now = std::chrono::steady_clock::now();
    auto end = now + options_.proof_time;
    if (options_.deadline) end = std::min(end, now + (*options_.deadline - now) / 2);
    const Deadline deadline(options_.stop, end);
    SearchProof proof{level.cell_m(), static_cast<int>(bounded.headings.size()), 2 * largest + 1, 0.0, 0.0, true, 0.0};
    for (int scale = -largest; scale <= largest; ++scale) {
      const LevelFeatures features = level.at_scale(scale);
      bounded.features = &features.map;
      bounded.least_cells = features.least_cells;
      BoundedResult found = search_with_bound(bounded, deadline);
      for (LatticePose& pose : found.poses) {
        pose.scale = scale;
        bounded.known = std::max(bounded.known, pose.score);
      }
      candidates.insert(candidates.end(), found.poses.begin(), found.poses.end());
      proof.bound = std::max(proof.bound, found.bound);
      proof.complete = proof.complete && found.complete;
      proof.excluded_share += found.excluded_share;
    }
    proof.best_score = bounded.known;
    proof.excluded_share /= proof.scales;
    result.proof = proof;
  }

  bool within_region(const Level& level, const LatticePose& pose) const {
    const SearchRegion wide = grown(region_, 0.71 * level.cell_m(), level.bins.step());
    const GridPose at = level.pose_of(pose);
    return wide.contains(at.position) && wide.contains(at.heading);
  }

  /// The best `keep` of those within the region, and of the others, that are apart; best first.
  std::vector<LatticePose> distinct(std::vector<LatticePose> poses, const Level& level, double apart_m,
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

  /// From the cells of one level to those of the next finer one.
  static void descend(std::vector<LatticePose>& candidates) {
    for (LatticePose& pose : candidates) {
      pose.cell = {2 * pose.cell.col, 2 * pose.cell.row};
      pose.bin *= 2;
      pose.scale *= 2;
    }
  }

  /// Modes from the best candidates of the region, rivals from all others.
  void rank(const std::vector<LatticePose>& candidates, SearchResult& result) {
    const Level& finest = levels_.front();
    bool best_seen = false;
    std::vector<LatticePose> inside;
    for (const LatticePose& pose : candidates) {
      const bool in_region = within_region(finest, pose);
      if (in_region) inside.push_back(pose);
      if (in_region && !best_seen) {
        best_seen = true;
      } else {
        result.background.rivals.push_back(pose.score);
        if (in_region) result.background.rivals_within.push_back(pose.score);
      }
    }
    const double scanned = scanned_.area_km2() * std::min(1.0, scanned_.heading_half_width.degrees() / 180.0);
    const double asked = region_.area_km2() * std::min(1.0, region_.heading_half_width.degrees() / 180.0);
    result.background.region_share = scanned > 0.0 ? std::clamp(asked / scanned, 1e-6, 1.0) : 1.0;
    for (const LatticePose& pose : inside) {
      if (result.modes.size() >= static_cast<std::size_t>(std::max(1, options_.max_modes))) break;
      if (deadline_.over() && !result.modes.empty()) {
        result.refined = false;
        break;
      }
      result.modes.push_back(mode_at(pose, result.background));
    }
    std::ranges::stable_sort(result.modes, std::ranges::greater{}, &SearchMode::score);
  }

  SearchMode mode_at(LatticePose pose, const ScoreBackground& background) const {
    Level level = levels_.front();
    level.bins = level.bins.halved();
    pose.bin *= 2;
    Peak peak = peak_around(level, pose);
    for (int moves = 0; moves < 3; ++moves) {
      const std::array<int, 3> top = highest(peak.scores);
      if (top == std::array<int, 3>{}) break;
      pose = {{pose.cell.col + top[0], pose.cell.row + top[1]}, pose.bin + top[2], 0.0, pose.scale};
      peak = peak_around(level, pose);
    }
    const PeakShape shape = shape_of(peak.scores, background);
    const double cell = level.cell_m();
    const std::array<double, 3> unit{cell, -cell, level.bins.step().radians()};  // rows grow to the south
    SearchMode mode;
    mode.pose = level.pose_of(pose);
    mode.pose.position.east_m += unit[0] * shape.offset[0];
    mode.pose.position.north_m += unit[1] * shape.offset[1];
    mode.pose.heading += Angle::radians(unit[2] * shape.offset[2]);
    mode.scale = level.scales.factor(pose.scale);
    mode.score = peak.scores[kPeakRadius][kPeakRadius][kPeakRadius];
    mode.pearson = pearson(peak.centre).value_or(0.0);
    mode.rho = rho(peak.centre).value_or(0.0);
    mode.observed_cells = peak.centre.n;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) mode.covariance[i][j] = unit[i] * unit[j] * shape.covariance[i][j];
      mode.covariance[i][i] += unit[i] * unit[i] / 12.0;  // the lattice is no finer than that
    }
    return mode;
  }

  const GridReader& read_;
  const SearchRegion& region_;
  const SearchOptions& options_;
  Deadline deadline_;
  int coarsest_;
  std::vector<Level> levels_;  ///< finest first
  double separation_m_ = 0.0;
  SearchRegion scanned_;
};

}  // namespace

bool SearchRegion::contains(GridPoint point) const {
  return box.contains(point) && (!circle || distance_m(point, circle->centre) <= circle->radius_m);
}

bool SearchRegion::contains(Angle grid_heading) const {
  return heading_half_width.radians() >= std::numbers::pi ||
         angular_distance(grid_heading, heading) <= heading_half_width;
}

double SearchRegion::area_km2() const {
  const double boxed = box.empty() ? 0.0 : box.width_m() * box.height_m() * 1e-6;
  if (!circle) return boxed;
  return std::min(boxed, std::numbers::pi * circle->radius_m * circle->radius_m * 1e-6);
}

double ScoreBackground::log_likelihood(double score) const {
  if (sd <= 0.0 || score <= 0.0) return 0.0;
  constexpr double kPerfect = 0.9999;
  const double shared = std::min(score, kPerfect);
  return -kTemper * 0.5 * std::log1p(-shared * shared) / (sd * sd);
}

SearchResult search(const GridReader& read, double finest_cell_m, const FeatureMap& features,
                    const SearchRegion& region, const SearchOptions& options) {
  return Search(read, finest_cell_m, features, region, options).run();
}

}  // namespace roadfix
