#include "core/search/search_scan.hpp"

#include <algorithm>
#include <cmath>

#include "core/search/refine.hpp"
#include "core/search/score_spread.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kScanMaxima = 16384;
constexpr std::size_t kCandidatesAround = 256;  // followed from outside of the region
constexpr double kScanTimeShare = 0.75;         // of a limited time; the rest is for following the candidates
constexpr int kRivalsWanted = 1000;             // distinct places that chance is estimated from
constexpr double kKm2AtAllHeadings = 50.0;      // regions up to this area are scanned at all headings, larger at fewer

// Searched around a region that has surroundings: half a footprint away, a place shares few streets with one inside.
constexpr double kSidesBeyond = 0.5;
constexpr double kLeastKm2 = 4.0;  // in all

}  // namespace

SearchScan::SearchScan(const SearchLevels& levels, const SearchOptions& options)
    : levels_(levels),
      options_(options),
      separation_m_(std::max(kCandidatesApartCells * levels.coarse().cell_m(), 0.1 * levels.side_m())),
      scanned_(enlarged()) {}

/// Chance is estimated from the best places at all headings, whatever range is asked for: a narrow range holds so few
/// places that poor ones are among the best of them, and a wrong place would stand out.
PoseRegion SearchScan::at_more_headings() const {
  PoseRegion result = levels_.region();
  const Angle told = Angle::degrees(180.0 * std::min(1.0, kKm2AtAllHeadings / result.area_km2()));
  if (options_.surroundings) result.heading_half_width += kHeadingsBeyond;
  result.heading_half_width = std::max(result.heading_half_width, told);
  return result;
}

/// A small region holds too few places to estimate what chance gives, and a wrong prior does not hold the true place:
/// the surroundings are scanned as well.
PoseRegion SearchScan::enlarged() const {
  const PoseRegion region = at_more_headings();
  const double turns = region.heading_half_width.degrees() / 180.0;
  const double places_per_m2 = levels_.coarse().bins.count() / (2.0 * kDistinctBins) / (separation_m_ * separation_m_);
  const bool beyond = options_.surroundings.has_value();
  const double wanted_m2 = std::max(kRivalsWanted / places_per_m2, beyond ? 1e6 * kLeastKm2 : 0.0);
  PoseRegion result = region.grown(beyond ? kSidesBeyond * levels_.side_m() : 0.0, {});
  if (result.area_km2() * 1e6 * std::min(turns, 1.0) < wanted_m2) {
    const GridPoint centre = region.box.centre();
    result.box = united(result.box, grown({centre, centre}, 0.5 * std::sqrt(wanted_m2)));
    result.circle.reset();
    result.quads.clear();
    result.heading_half_width = Angle::degrees(180.0);
  }
  if (beyond) result.box = united(region.box, intersection(result.box, *options_.surroundings));
  return result;
}

ScanRequest SearchScan::request() const {
  const Level& coarse = levels_.coarse();
  ScanRequest request;
  request.positions = GridGeometry::covering(scanned_.box, coarse.cell_m());
  request.bins = coarse.bins;
  const PoseRegion wide = SearchLevels::widened(scanned_, coarse);
  request.headings = bins_within(request.bins, wide);
  request.eligible = cells_within(request.positions, wide);
  request.keep = kScanMaxima;
  request.threads = options_.threads;
  return request;
}

/// The map below footprints of any scale at these positions.
std::shared_ptr<const ScanMap> SearchScan::map_below(const GridGeometry& positions) const {
  const Level& coarse = levels_.coarse();
  const int reach = coarse.reach(coarse.scales.reach());
  const GridGeometry window = positions.padded(reach);
  const int block = scan_block(coarse.features.map);
  // The halvings are part of the key since searches differ in the finest cells that these are means of.
  const Deadline until_stopped(options_.deadline.stop());  // it is a small part of the scan, which has nothing without
  return get_or_build<ScanMap>(options_.cache, window, {reach, block, levels_.halvings(levels_.coarsest())},
                               until_stopped, [&] { return ScanMap(coarse.read(window), reach, block); });
}

/// The coarser the cells, the wider scores spread. If the scan has coarser cells than calibrations were learned in, the
/// spread is estimated from a sample of poses in those; nullopt if not, or if the sample is too small.
std::optional<double> SearchScan::finer_spread() const {
  if (levels_.spread_level() == levels_.coarsest()) return std::nullopt;
  return score_spread(levels_.at(levels_.spread_level()), scanned_, options_.deadline);
}

SearchScan::Maxima SearchScan::maxima() const {
  const Level& coarse = levels_.coarse();
  const int largest = coarse.scales.reach();
  ScanRequest asked = request();
  const LatticeIndex origin = asked.positions.origin;
  const std::shared_ptr<const ScanMap> map = map_below(asked.positions);
  const Deadline end = options_.deadline.after(kScanTimeShare);
  Maxima all;
  all.headings = asked.headings.size();
  std::size_t before = 0;
  if (options_.progress) {
    asked.scanned = [&](std::size_t here) {
      options_.progress(static_cast<std::int64_t>(before + here),
                        static_cast<std::int64_t>(all.headings) * coarse.scales.count());
    };
  }
  for (int scale = -largest; scale <= largest; ++scale, before += all.headings) {
    const ScanResult found = coarse_scan(*map, coarse.at_scale(scale).map, asked, end);
    all.share += found.share;
    all.poses += found.poses;
    all.score_square_sum += found.score_square_sum;
    for (const ScanPose& pose : found.maxima) {
      const LatticePose lattice{
          {origin.col + pose.col, origin.row + pose.row}, pose.bin, static_cast<double>(pose.score), scale};
      (levels_.within_region(coarse, lattice) ? all.inside : all.outside).push_back(lattice);
    }
  }
  all.share /= coarse.scales.count();
  correct(all.inside);
  correct(all.outside);
  return all;
}

/// No score exceeds 1. Where one does, the means of the scan do not hold: on bare ground beside a road, and of narrow
/// footprints. Many such poses would take the places of all others.
void SearchScan::correct(std::vector<LatticePose>& poses) const {
  constexpr double kHighestScore = 1.0;
  const auto first = std::stable_partition(poses.begin(), poses.end(),
                                           [](const LatticePose& pose) { return pose.score <= kHighestScore; });
  std::vector<LatticePose> wrong(first, poses.end());
  if (wrong.empty() || !refine(levels_.coarse(), {.cells = 1, .bins = 0}, options_.deadline, wrong)) return;
  std::ranges::copy(wrong, first);
}

Scanned SearchScan::run() const {
  const Level& coarse = levels_.coarse();
  const Maxima found = maxima();
  Scanned scanned;
  scanned.poses = found.poses;
  scanned.share = found.share;
  scanned.headings = static_cast<int>(found.headings);
  if (found.poses > 0) {
    const double sd = std::sqrt(found.score_square_sum / static_cast<double>(found.poses));
    scanned.sd = finer_spread().value_or(sd);
  }
  scanned.candidates =
      levels_.distinct_candidates(found.inside, coarse, levels_.candidates_followed(levels_.coarsest()));
  const std::vector<LatticePose> others = levels_.distinct_candidates(found.outside, coarse, kCandidatesAround);
  scanned.candidates.insert(scanned.candidates.end(), others.begin(), others.end());
  return scanned;
}

}  // namespace roadfix
