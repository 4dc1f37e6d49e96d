#include "core/match/refine.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/match/coarse_scan.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"

namespace roadfix {
namespace {

/// The map around a pose, wide enough for the footprint at the poses up to `cells` away.
MapPlane plane_around(const Level& level, const LatticePose& pose, int cells) {
  const int reach = level.reach(std::min(pose.scale + 1, level.scales.reach())) + cells;
  const LatticeIndex cell = pose.cell;
  const GridGeometry window{level.cell_m(), {cell.col - reach, cell.row - reach}, 2 * reach + 1, 2 * reach + 1};
  return MapPlane(level.read(window).cells, 0);
}

/// Sums at the (2 cells + 1)^2 places around the centre of the plane, row by row.
std::vector<MatchSums> sums_around(const MapPlane& plane, const Footprint& footprint, int cells) {
  std::vector<PlaneCell> places;
  for (int row = -cells; row <= cells; ++row) {
    for (int col = -cells; col <= cells; ++col) places.push_back({plane.cols() / 2 + col, plane.rows() / 2 + row});
  }
  std::vector<MatchSums> sums(places.size());
  match_sums(plane, footprint, places, sums);
  return sums;
}

}  // namespace

GridPose Level::pose_of(const LatticePose& pose) const {
  return {{(pose.cell.col + 0.5) * cell_m(), -(pose.cell.row + 0.5) * cell_m()}, bins.heading(bins.wrapped(pose.bin))};
}

LevelFeatures::LevelFeatures(FeatureMap features, double least_share)
    : map(std::move(features)),
      turnable(map),
      full_cells(static_cast<std::int64_t>(map.cells.observed_count())),
      least_cells(std::max(1.0, least_share * static_cast<double>(full_cells))) {}

LevelFeatures Level::at_scale(int index) const {
  if (index == 0) return features;
  FeatureMap scaled = source;
  scaled.cell_m *= scales.factor(index);
  return {resampled(scaled, cell_m()), least_share};
}

int Level::reach(int scale) const {
  const int reach = footprint_reach(features.map);
  return scale == 0 ? reach : static_cast<int>(std::ceil(scales.factor(scale) * reach)) + 1;
}

bool refine(const Level& level, int cells, int bins, const Deadline& deadline, std::vector<LatticePose>& candidates) {
  std::vector<MapPlane> planes;
  planes.reserve(candidates.size());
  // Turning the feature map is the expensive part, so all candidates that ask for a bin share it.
  std::map<std::pair<int, int>, std::vector<std::size_t>> candidates_of;  // scale and bin
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (deadline.over()) return false;
    planes.push_back(plane_around(level, candidates[i], cells));
    for (int scale = candidates[i].scale - 1; scale <= candidates[i].scale + 1; ++scale) {
      if (std::abs(scale) > level.scales.reach()) continue;
      for (int d = -bins; d <= bins; ++d)
        candidates_of[{scale, level.bins.wrapped(candidates[i].bin + d)}].push_back(i);
    }
  }
  std::map<int, LevelFeatures> features;
  struct Task {
    int scale;
    int bin;
    const LevelFeatures* features;
    const std::vector<std::size_t>* candidates;
    std::vector<LatticePose> best;
  };
  std::vector<Task> tasks;
  for (const auto& [key, members] : candidates_of) {
    const auto [scale, bin] = key;
    if (deadline.over()) return false;
    if (!features.contains(scale)) features.emplace(scale, level.at_scale(scale));
    tasks.push_back({scale, bin, &features.at(scale), &members, {}});
  }
  std::atomic<bool> whole{true};
  parallel_for(static_cast<int>(tasks.size()), level.threads, [&](int t) {
    if (deadline.over()) {
      whole = false;
      return;
    }
    Task& task = tasks[static_cast<std::size_t>(t)];
    const Footprint footprint = footprint_at(task.features->turnable, level.bins.heading(task.bin));
    for (const std::size_t i : *task.candidates) {
      const std::vector<MatchSums> sums = sums_around(planes[i], footprint, cells);
      LatticePose best{candidates[i].cell, task.bin, 0.0, task.scale};
      for (std::size_t k = 0; k < sums.size(); ++k) {
        const double score = score_of(sums[k], task.features->full_cells, task.features->least_cells);
        if (score <= best.score) continue;
        const int index = static_cast<int>(k);
        const int width = 2 * cells + 1;
        best.cell = {candidates[i].cell.col + index % width - cells, candidates[i].cell.row + index / width - cells};
        best.score = score;
      }
      task.best.push_back(best);
    }
  });
  if (!whole) return false;
  std::vector<LatticePose> refined = candidates;
  for (LatticePose& pose : refined) pose.score = 0.0;
  for (const Task& task : tasks) {
    for (std::size_t k = 0; k < task.best.size(); ++k) {
      LatticePose& pose = refined[(*task.candidates)[k]];
      if (task.best[k].score > pose.score) pose = task.best[k];
    }
  }
  candidates = std::move(refined);
  return true;
}

Peak peak_around(const Level& level, const LatticePose& pose) {
  const LevelFeatures features = level.at_scale(pose.scale);
  const MapPlane plane = plane_around(level, pose, kPeakRadius);
  Peak peak;
  for (int d = 0; d < kPeakSize; ++d) {
    const Footprint footprint =
        footprint_at(features.turnable, level.bins.heading(level.bins.wrapped(pose.bin + d - kPeakRadius)));
    const std::vector<MatchSums> sums = sums_around(plane, footprint, kPeakRadius);
    for (int row = 0; row < kPeakSize; ++row) {
      for (int col = 0; col < kPeakSize; ++col) {
        const auto at = static_cast<std::size_t>(row * kPeakSize + col);
        peak.scores[static_cast<std::size_t>(d)][static_cast<std::size_t>(row)][static_cast<std::size_t>(col)] =
            score_of(sums[at], features.full_cells, features.least_cells);
        if (d == kPeakRadius && row == kPeakRadius && col == kPeakRadius) peak.centre = sums[at];
      }
    }
  }
  return peak;
}

}  // namespace roadfix
