#include "core/search/search_modes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/search/mode_finder.hpp"
#include "core/search/nearby_peak.hpp"
#include "core/search/shared_road.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kOutside = 4;  // modes around the region

// A place at a heading outside the given range is no rival unless it is ten times as likely as the best one: one in a
// thousand headings given is wrong (a camera mounted the other way round).
const double kHeadingIsWrong = std::log(10.0);

/// Of the finest level, whose bins are twice as wide as those of modes.
LatticePose lattice_pose_of(const Level& finest, const SearchMode& mode) {
  return {lattice_index(mode.pose.position, finest.cell_m()), finest.bins.nearest(mode.pose.heading), mode.score,
          finest.scales.nearest(std::log(mode.scale))};
}

std::optional<SearchMode> nearby_mode(const SearchLevels& levels, double apart_m, const SearchMode& best,
                                      const ModeFinder& finder) {
  const Level& finest = levels.finest();
  const auto peak = nearby_peak(finest, lattice_pose_of(finest, best), apart_m);
  if (!peak) return std::nullopt;
  const SearchMode mode = finder.at(*peak);
  const bool another = levels.region().contains(mode.pose) && !finder.on_one_peak(mode, best);
  return another ? std::optional(mode) : std::nullopt;
}

double other_roads_m(const Level& finest, const SearchMode& mode, int straight_roads) {
  // Width of the stripe that a straight road lies in.
  constexpr double kLeastLineM = 20.0;
  constexpr double kLineShare = 0.05;  // of the footprint's side
  constexpr double kCarriagewaysM = 40.0;
  const double cell_m = finest.cell_m();
  const FeatureMap north_up = rotated(resampled(finest.source, cell_m, mode.scale), mode.pose.heading);
  const LatticeIndex nadir = lattice_index(mode.pose.position, cell_m);
  const LatticeIndex first{nadir.col - static_cast<int>(std::floor(north_up.nadir.col)),
                           nadir.row - static_cast<int>(std::floor(north_up.nadir.row))};
  const RoadGrid ground = finest.read({cell_m, first, north_up.cells.cols(), north_up.cells.rows()});
  const double side_m = cell_m * std::sqrt(static_cast<double>(mode.observed_cells));
  const double line_m = std::max({kLeastLineM, kLineShare * side_m, 2.0 * cell_m});
  const StraightRoad straight{line_m / cell_m, kCarriagewaysM / cell_m};
  const double narrowest = std::max(kRoadWidthM / cell_m, 1.0);
  return cell_m * road_beside_straight_ones(ground.cells, north_up.cells, straight_roads, straight, narrowest);
}

double poses_of(const PoseRegion& region) {
  return region.area_km2() * std::min(1.0, region.heading_half_width.degrees() / 180.0);
}

void append_new(const ModeFinder& finder, const std::vector<SearchMode>& more, std::vector<SearchMode>& modes) {
  for (const SearchMode& mode : more) {
    if (std::ranges::none_of(modes, [&](const SearchMode& known) { return finder.on_one_peak(mode, known); })) {
      modes.push_back(mode);
    }
  }
}

/// Without poses at headings outside the region's range, except for those that are far likelier than the best mode.
std::vector<LatticePose> worth_a_look(const SearchLevels& levels, std::vector<LatticePose> around,
                                      const SearchMode& best, const ScoreBackground& background) {
  const PoseRegion nearly = levels.region().grown(0.0, kHeadingsBeyond);
  const double best_likelihood = background.log_likelihood(best.score);
  std::erase_if(around, [&](const LatticePose& pose) {
    const double ahead = background.log_likelihood(pose.score) - best_likelihood;
    return !nearly.contains(levels.finest().pose_of(pose).heading) && ahead < kHeadingIsWrong;
  });
  return around;
}

/// The modes that lie around the region, without flanks of the best one in it.
std::vector<SearchMode> modes_outside(const SearchLevels& levels, const PoseRegion& scanned, const ModeFinder& finder,
                                      std::vector<SearchMode> modes, const SearchMode& best) {
  std::erase_if(modes, [&](const SearchMode& mode) {
    return !scanned.contains(mode.pose.position) || levels.region().contains(mode.pose) ||
           finder.on_one_peak(mode, best);
  });
  return modes;
}

std::vector<double> scores_of(std::span<const LatticePose> poses) {
  std::vector<double> scores;
  for (const LatticePose& pose : poses) scores.push_back(pose.score);
  return scores;
}

/// Few places compete for what lies around a region where that is a strip along its border, so the poorest are followed
/// too. Where the tail of chance begins is known from the region alone then.
std::span<const LatticePose> comparable_around(const RankedPoses& poses) {
  const std::span<const LatticePose> around(poses.around);
  if (around.size() >= poses.inside.size()) return around;
  const double poorest = poses.inside.back().score;
  const auto poorer = std::ranges::find_if(around, [&](const LatticePose& pose) { return pose.score < poorest; });
  return around.first(static_cast<std::size_t>(poorer - around.begin()));
}

}  // namespace

RankedPoses::RankedPoses(const SearchLevels& levels, const std::vector<LatticePose>& poses) {
  for (const LatticePose& pose : poses) {
    (levels.within_region(levels.finest(), pose) ? inside : around).push_back(pose);
  }
}

void set_rivals(const SearchLevels& levels, const SearchScan& scan, const SearchOptions& options,
                const RankedPoses& poses, ScoreBackground& background) {
  // No more than a region has by itself. But all of them if it was scanned beyond its border only because it is tiny:
  // then its own are what chance is estimated from.
  const bool tiny = !options.surroundings && scan.scanned().area_km2() > levels.region().area_km2();
  const std::size_t count = tiny ? 2 * kSurvivors : kSurvivors;
  const std::span<const LatticePose> inside(poses.inside);
  background.rivals_within = scores_of(inside.subspan(std::min<std::size_t>(1, inside.size())));
  std::ranges::merge(background.rivals_within, scores_of(comparable_around(poses)),
                     std::back_inserter(background.rivals), std::ranges::greater{});
  background.rivals.resize(std::min(background.rivals.size(), count));
  const double all = poses_of(scan.scanned());
  background.region_share = all > 0.0 ? std::clamp(poses_of(levels.region()) / all, 1e-6, 1.0) : 1.0;
}

FoundModes find_modes(const SearchLevels& levels, const SearchScan& scan, const SearchOptions& options,
                      const RankedPoses& poses, const ScoreBackground& background) {
  ModeFinder finder(levels.finest(), background, options.deadline);
  FoundModes found;
  found.modes = finder.first_of(poses.inside, kRankedModes);
  if (found.modes.empty()) return found;
  if (options.max_modes > kRankedModes) {
    append_new(finder, finder.first_of(poses.inside, static_cast<std::size_t>(options.max_modes)), found.modes);
  }
  SearchMode& best = found.modes.front();
  const bool looks_nearby = !options.deadline.over();
  if (looks_nearby) found.nearby = nearby_mode(levels, scan.separation_m(), best, finder);
  if (found.nearby && found.nearby->score > best.score) std::swap(*found.nearby, best);
  found.other_roads_m = other_roads_m(levels.finest(), best, options.straight_roads);
  if (options.surroundings) {
    std::vector<SearchMode> others = finder.first_of(worth_a_look(levels, poses.around, best, background), kOutside);
    found.outside = modes_outside(levels, scan.scanned(), finder, std::move(others), best);
  }
  found.complete = looks_nearby && finder.in_time();
  return found;
}

}  // namespace roadfix
