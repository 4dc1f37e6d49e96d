#include "core/match/search_modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/grid/resample.hpp"
#include "core/match/peak.hpp"
#include "core/match/shared_road.hpp"

namespace roadfix {
namespace {

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
  mode.rho = rho(peak.centre).value_or(0.0);
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

}  // namespace

void rank(const SearchLevels& levels, const PoseRegion& scanned, const SearchOptions& options, const Deadline& deadline,
          const std::vector<LatticePose>& candidates, SearchResult& result) {
  const Level& finest = levels.finest();
  bool best_seen = false;
  std::vector<LatticePose> inside;
  for (const LatticePose& pose : candidates) {
    const bool in_region = levels.within_region(finest, pose);
    if (in_region) inside.push_back(pose);
    if (in_region && !best_seen) {
      best_seen = true;
    } else {
      result.background.rivals.push_back(pose.score);
      if (in_region) result.background.rivals_within.push_back(pose.score);
    }
  }
  // The region's own places go deeper than those at other headings: as many count as where none is told.
  std::vector<double>& rivals = result.background.rivals;
  if (scanned.area_km2() == levels.region().area_km2()) rivals.resize(std::min(rivals.size(), kSurvivors));
  const double all = poses_of(scanned);
  result.background.region_share = all > 0.0 ? std::clamp(poses_of(levels.region()) / all, 1e-6, 1.0) : 1.0;
  for (const LatticePose& pose : inside) {
    if (result.modes.size() >= static_cast<std::size_t>(std::max(1, options.max_modes))) break;
    if (deadline.over() && !result.modes.empty()) {
      result.refined = false;
      break;
    }
    const SearchMode mode = mode_at(finest, pose, result.background);
    const auto known =
        std::ranges::find_if(result.modes, [&](const SearchMode& other) { return on_one_peak(finest, mode, other); });
    if (known == result.modes.end()) {
      result.modes.push_back(mode);
    } else if (mode.score > known->score) {
      *known = mode;
    }
  }
  std::ranges::stable_sort(result.modes, std::ranges::greater{}, &SearchMode::score);
  if (!result.modes.empty()) result.modes.front().shared_road_m2 = shared_road_m2(finest, result.modes.front());
}

}  // namespace roadfix
