#include "core/match/search_modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/match/nearby_peak.hpp"
#include "core/match/peak.hpp"
#include "core/match/shared_road.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kOutside = 4;  // modes around the region, to tell the best of

// A place at a heading beside those that were told is no rival, unless it is ten times as likely as the best one: of a
// thousand headings that are told one is wrong (a camera mounted the other way round).
const double kHeadingIsWrong = std::log(10.0);

SearchMode mode_at(Level level, LatticePose pose, const ScoreBackground& background) {
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
  mode.observed_cells = peak.centre.n;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) mode.covariance[i][j] = unit[i] * unit[j] * shape.covariance[i][j];
    mode.covariance[i][i] += unit[i] * unit[i] / 12.0;  // the lattice is no finer than that
  }
  return mode;
}

/// Whether one lies among the scores that tell the other's shape.
bool on_one_peak(const Level& finest, const SearchMode& a, const SearchMode& b) {
  return distance_m(a.pose.position, b.pose.position) <= kPeakRadius * finest.cell_m() &&
         angular_distance(a.pose.heading, b.pose.heading) <= double{kPeakRadius} * finest.bins.halved().step();
}

/// Of the finest level, whose bins are twice as wide as those of modes.
LatticePose lattice_pose_of(const Level& finest, const SearchMode& mode) {
  const int bin = static_cast<int>(std::lround(mode.pose.heading.radians() / finest.bins.step().radians()));
  return {lattice_index(mode.pose.position, finest.cell_m()), finest.bins.wrapped(bin), mode.score,
          finest.scales.nearest(std::log(mode.scale))};
}

std::optional<SearchMode> nearby_mode(const SearchLevels& levels, double apart_m, const SearchMode& best,
                                      const ScoreBackground& background) {
  const Level& finest = levels.finest();
  const auto peak = nearby_peak(finest, lattice_pose_of(finest, best), apart_m);
  if (!peak) return std::nullopt;
  const SearchMode mode = mode_at(finest, *peak, background);
  const bool another = levels.region().contains(mode.pose) && !on_one_peak(finest, mode, best);
  return another ? std::optional(mode) : std::nullopt;
}

double shared_road_m2(const Level& finest, const SearchMode& mode) {
  const double cell_m = finest.cell_m();
  const FeatureMap north_up = rotated(resampled(finest.source, cell_m, mode.scale), mode.pose.heading);
  const LatticeIndex nadir = lattice_index(mode.pose.position, cell_m);
  const LatticeIndex first{nadir.col - static_cast<int>(std::floor(north_up.nadir.col)),
                           nadir.row - static_cast<int>(std::floor(north_up.nadir.row))};
  const RoadGrid ground = finest.read({cell_m, first, north_up.cells.cols(), north_up.cells.rows()});
  return shared_road_cells(ground.cells, north_up.cells) * cell_m * cell_m;
}

double poses_of(const PoseRegion& region) {
  return region.area_km2() * std::min(1.0, region.heading_half_width.degrees() / 180.0);
}

/// The first `count` of the candidates within the cell, best first; flanks of one peak give one mode.
std::vector<SearchMode> modes_of(const Level& finest, const std::vector<LatticePose>& candidates, std::size_t count,
                                 const Deadline& deadline, SearchResult& result) {
  std::vector<SearchMode> modes;
  for (const LatticePose& pose : candidates) {
    if (modes.size() >= count) break;
    if (deadline.over() && !modes.empty()) {
      result.refined = false;
      break;
    }
    const SearchMode mode = mode_at(finest, pose, result.background);
    const auto known =
        std::ranges::find_if(modes, [&](const SearchMode& other) { return on_one_peak(finest, mode, other); });
    if (known == modes.end()) {
      modes.push_back(mode);
    } else if (mode.score > known->score) {
      *known = mode;
    }
  }
  std::ranges::stable_sort(modes, std::ranges::greater{}, &SearchMode::score);
  return modes;
}

void append_new(const Level& finest, const std::vector<SearchMode>& more, std::vector<SearchMode>& modes) {
  for (const SearchMode& mode : more) {
    if (std::ranges::none_of(modes, [&](const SearchMode& known) { return on_one_peak(finest, mode, known); })) {
      modes.push_back(mode);
    }
  }
}

/// The first of the modes that is around the region, and not the best one in it seen from across the border.
std::optional<SearchMode> best_around(const SearchLevels& levels, const PoseRegion& scanned,
                                      const std::vector<SearchMode>& modes, const SearchMode& best) {
  const auto found = std::ranges::find_if(modes, [&](const SearchMode& mode) {
    return scanned.contains(mode.pose.position) && !levels.region().contains(mode.pose) &&
           !on_one_peak(levels.finest(), mode, best);
  });
  return found == modes.end() ? std::nullopt : std::optional(*found);
}

std::vector<double> scores_of(std::span<const LatticePose> poses) {
  std::vector<double> scores;
  for (const LatticePose& pose : poses) scores.push_back(pose.score);
  return scores;
}

/// Of places within the region and around it, best first: the best `count` beside the best one tell of chance.
void set_rivals(std::span<const LatticePose> inside, std::span<const LatticePose> around, std::size_t count,
                ScoreBackground& background) {
  background.rivals_within = scores_of(inside.subspan(std::min<std::size_t>(1, inside.size())));
  std::ranges::merge(background.rivals_within, scores_of(around), std::back_inserter(background.rivals),
                     std::ranges::greater{});
  background.rivals.resize(std::min(background.rivals.size(), count));
}

}  // namespace

void rank(const SearchLevels& levels, const SearchScan& scan, const SearchOptions& options, const Deadline& deadline,
          const std::vector<LatticePose>& candidates, SearchResult& result) {
  const Level& finest = levels.finest();
  const PoseRegion& scanned = scan.scanned();
  std::vector<LatticePose> inside;
  std::vector<LatticePose> around;
  for (const LatticePose& pose : candidates) {
    (levels.within_region(finest, pose) ? inside : around).push_back(pose);
  }
  // As many as where no other was scanned: those of a region go deeper than those around it. But where it is scanned
  // beyond its border only because it is tiny, its own are what chance is told by.
  const bool tiny = !options.surroundings && scanned.area_km2() > levels.region().area_km2();
  set_rivals(inside, around, tiny ? 2 * kSurvivors : kSurvivors, result.background);
  const double all = poses_of(scanned);
  result.background.region_share = all > 0.0 ? std::clamp(poses_of(levels.region()) / all, 1e-6, 1.0) : 1.0;
  result.modes = modes_of(finest, inside, kRankedModes, deadline, result);
  if (result.modes.empty()) return;
  if (options.max_modes > kRankedModes) {
    append_new(finest, modes_of(finest, inside, static_cast<std::size_t>(options.max_modes), deadline, result),
               result.modes);
  }
  SearchMode& best = result.modes.front();
  if (deadline.over()) {
    result.refined = false;
  } else {
    result.nearby = nearby_mode(levels, scan.separation_m(), best, result.background);
  }
  if (result.nearby && result.nearby->score > best.score) std::swap(*result.nearby, best);
  best.shared_road_m2 = shared_road_m2(finest, best);
  if (!options.surroundings) return;
  const PoseRegion nearly = levels.region().grown(0.0, kHeadingsBeyond);
  const double best_likelihood = result.background.log_likelihood(best.score);
  std::erase_if(around, [&](const LatticePose& pose) {
    const double ahead = result.background.log_likelihood(pose.score) - best_likelihood;
    return !nearly.contains(finest.pose_of(pose).heading) && ahead < kHeadingIsWrong;
  });
  result.outside = best_around(levels, scanned, modes_of(finest, around, kOutside, deadline, result), best);
}

}  // namespace roadfix
