#include "core/search/search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/search/refine.hpp"
#include "core/search/search_levels.hpp"
#include "core/search/search_modes.hpp"
#include "core/search/search_proof.hpp"
#include "core/search/search_scan.hpp"
#include "core/units/memory.hpp"

namespace roadfix {

double ScoreBackground::log_likelihood(double score) const {
  if (sd <= 0.0 || score <= 0.0) return 0.0;
  constexpr double kPerfect = 0.9999;
  const double shared = std::min(score, kPerfect);
  return -kTemper * 0.5 * std::log1p(-shared * shared) / (sd * sd);
}

namespace {

/// After a search of so much ground freed memory goes back to the system.
constexpr double kMuchGroundKm2 = 100.0;

SearchResult result_of(const SearchLevels& levels, const Scanned& scanned) {
  SearchResult result;
  result.cell_m = levels.finest().cell_m();
  result.coarse_cell_m = levels.coarse().cell_m();
  result.headings = scanned.headings;
  result.scales = levels.coarse().scales.count();
  result.scanned_share = scanned.share;
  result.background.sd = scanned.sd;
  result.background.poses = scanned.poses;
  return result;
}

SearchResult searched(const GridReader& read, double finest_cell_m, const FeatureMap& features,
                      const PoseRegion& region, const SearchOptions& options) {
  const SearchLevels levels(read, finest_cell_m, features, region, options);
  const SearchScan scan(levels, options);
  Scanned scanned = scan.run();
  SearchResult result = result_of(levels, scanned);
  std::vector<LatticePose> candidates = std::move(scanned.candidates);
  const auto prove_at = [&](int level) {
    if (options.proof_time && level == levels.proof_level()) result.proof = prove(levels, options, candidates);
  };
  result.refined = refine(levels.coarse(), {.cells = 1, .bins = 1}, options.deadline, candidates);
  prove_at(levels.coarsest());
  for (int k = levels.coarsest() - 1; k >= 0; --k) {
    candidates = levels.distinct_candidates(std::move(candidates), levels.at(k + 1), levels.candidates_followed(k + 1));
    descend(candidates);
    result.refined = refine(levels.at(k), {.cells = 2, .bins = 2}, options.deadline, candidates) && result.refined;
    prove_at(k);
  }
  candidates = levels.distinct(candidates, levels.finest(), {scan.separation_m(), kDistinctBins}, kSurvivors);
  const RankedPoses poses(levels, candidates);
  set_rivals(levels, scan, options, poses, result.background);
  FoundModes found = find_modes(levels, scan, options, poses, result.background);
  result.modes = std::move(found.modes);
  result.other_roads_m = found.other_roads_m;
  result.nearby = found.nearby;
  result.outside = std::move(found.outside);
  result.refined = result.refined && found.complete;
  return result;
}

}  // namespace

SearchResult search(const GridReader& read, double finest_cell_m, const FeatureMap& features, const PoseRegion& region,
                    const SearchOptions& options) {
  SearchResult result = searched(read, finest_cell_m, features, region, options);
  if (region.area_km2() >= kMuchGroundKm2) give_back_freed_memory();
  return result;
}

}  // namespace roadfix
