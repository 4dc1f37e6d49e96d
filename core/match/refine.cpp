#include "core/match/refine.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "core/grid/resample.hpp"
#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// The ground around a pose, wide enough for the footprint at the poses up to `cells` away.
GridGeometry window_around(const Level& level, const LatticePose& pose, int cells) {
  const int reach = level.reach(std::min(pose.scale + 1, level.scales.reach())) + cells;
  return padded({level.cell_m(), pose.cell, 1, 1}, reach);
}

std::int64_t cells_of(const GridGeometry& window) { return std::int64_t{window.cols} * window.rows; }

GridGeometry joined(const GridGeometry& a, const GridGeometry& b) {
  const LatticeIndex first{std::min(a.origin.col, b.origin.col), std::min(a.origin.row, b.origin.row)};
  return {a.cell_m, first, std::max(a.origin.col + a.cols, b.origin.col + b.cols) - first.col,
          std::max(a.origin.row + a.rows, b.origin.row + b.rows) - first.row};
}

/// The map around candidates: one plane for all where they lie so close together that it is no larger than one for
/// each.
class GroundAround {
 public:
  /// `complete()` is false, and the rest must not be used, if time was over before.
  GroundAround(const Level& level, int cells, const Deadline& deadline, const std::vector<LatticePose>& candidates) {
    std::vector<GridGeometry> windows;
    std::int64_t apart = 0;
    for (const LatticePose& pose : candidates) {
      windows.push_back(window_around(level, pose, cells));
      apart += cells_of(windows.back());
    }
    if (!windows.empty()) {
      const GridGeometry all = std::accumulate(windows.begin() + 1, windows.end(), windows.front(), joined);
      if (cells_of(all) <= apart) windows.assign(1, all);
    }
    for (const GridGeometry& window : windows) {
      if (deadline.over()) return;
      planes_.push_back({window.origin, MapPlane(level.read(window).cells)});
    }
    complete_ = true;
  }

  bool complete() const { return complete_; }
  bool shared() const { return planes_.size() == 1; }
  const MapPlane& plane(std::size_t candidate) const { return at(candidate).plane; }
  PlaneCell place(std::size_t candidate, LatticeIndex cell) const {
    const LatticeIndex origin = at(candidate).origin;
    return {cell.col - origin.col, cell.row - origin.row};
  }

 private:
  struct Plane {
    LatticeIndex origin;
    MapPlane plane;
  };
  const Plane& at(std::size_t candidate) const { return planes_[shared() ? 0 : candidate]; }

  std::vector<Plane> planes_;
  bool complete_ = false;
};

/// The places up to `cells` around one, row by row.
void add_places_around(PlaneCell place, int cells, std::vector<PlaneCell>& places) {
  for (int row = -cells; row <= cells; ++row) {
    for (int col = -cells; col <= cells; ++col) places.push_back({place.col + col, place.row + row});
  }
}

/// Candidates that ask for the same scale and bin: turning the feature map is expensive, so they share it.
struct RefineTask {
  int scale;
  int bin;
  const LevelFeatures* features;
  std::vector<std::size_t> candidates;
  std::vector<LatticePose> best;  ///< of each candidate
};

/// The best of the poses around a candidate; `sums` are theirs, in the order of add_places_around().
LatticePose best_around(LatticeIndex cell, int cells, const RefineTask& task, std::span<const MatchSums> sums) {
  LatticePose best{cell, task.bin, 0.0, task.scale};
  const int width = 2 * cells + 1;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const double score = score_of(sums[k], task.features->full_cells, task.features->min_cells);
    if (score <= best.score) continue;
    const int index = static_cast<int>(k);
    best.cell = {cell.col + index % width - cells, cell.row + index / width - cells};
    best.score = score;
  }
  return best;
}

/// Indices of the candidates that ask for each (scale, bin).
using CandidatesOf = std::map<std::pair<int, int>, std::vector<std::size_t>>;

CandidatesOf by_scale_and_bin(const Level& level, int bins, const std::vector<LatticePose>& candidates) {
  CandidatesOf result;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (int scale = candidates[i].scale - 1; scale <= candidates[i].scale + 1; ++scale) {
      if (std::abs(scale) > level.scales.reach()) continue;
      for (int d = -bins; d <= bins; ++d) result[{scale, level.bins.wrapped(candidates[i].bin + d)}].push_back(i);
    }
  }
  return result;
}

/// What the tasks found best of each candidate.
std::vector<LatticePose> best_of(const std::vector<RefineTask>& tasks, std::vector<LatticePose> candidates) {
  for (LatticePose& pose : candidates) pose.score = 0.0;
  for (const RefineTask& task : tasks) {
    for (std::size_t k = 0; k < task.best.size(); ++k) {
      LatticePose& pose = candidates[task.candidates[k]];
      if (task.best[k].score > pose.score) pose = task.best[k];
    }
  }
  return candidates;
}

void run(RefineTask& task, const Level& level, int cells, const GroundAround& ground,
         const std::vector<LatticePose>& poses) {
  const PackedFootprint footprint = footprint_at(task.features->rotator, level.bins.heading(task.bin));
  std::vector<PlaneCell> places;
  for (const std::size_t i : task.candidates) add_places_around(ground.place(i, poses[i].cell), cells, places);
  std::vector<MatchSums> sums(places.size());
  const std::size_t each = places.size() / task.candidates.size();
  const std::size_t together = ground.shared() ? places.size() : each;
  for (std::size_t first = 0; first < places.size(); first += together) {
    match_sums(ground.plane(task.candidates[first / each]), footprint, std::span(places).subspan(first, together),
               std::span(sums).subspan(first, together));
  }
  for (std::size_t k = 0; k < task.candidates.size(); ++k) {
    task.best.push_back(
        best_around(poses[task.candidates[k]].cell, cells, task, std::span(sums).subspan(k * each, each)));
  }
}

}  // namespace

GridPose Level::pose_of(const LatticePose& pose) const {
  return {{(pose.cell.col + 0.5) * cell_m(), -(pose.cell.row + 0.5) * cell_m()}, bins.heading(bins.wrapped(pose.bin))};
}

LevelFeatures::LevelFeatures(FeatureMap features, double min_share)
    : map(std::move(features)),
      rotator(map),
      full_cells(static_cast<std::int64_t>(map.cells.observed_count())),
      min_cells(std::max(1.0, min_share * static_cast<double>(full_cells))) {}

LevelFeatures Level::at_scale(int index) const {
  if (index == 0) return features;
  return {resampled(source, cell_m(), scales.factor(index)), min_share};
}

int Level::reach(int scale) const {
  const int reach = footprint_reach(features.map);
  return scale == 0 ? reach : static_cast<int>(std::ceil(scales.factor(scale) * reach)) + 1;
}

GridGeometry padded(const GridGeometry& geometry, int cells) {
  return {geometry.cell_m,
          {geometry.origin.col - cells, geometry.origin.row - cells},
          geometry.cols + 2 * cells,
          geometry.rows + 2 * cells};
}

bool refine(const Level& level, int cells, int bins, const Deadline& deadline, std::vector<LatticePose>& candidates) {
  const GroundAround ground(level, cells, deadline, candidates);
  if (!ground.complete()) return false;
  std::map<int, LevelFeatures> at_scale;
  std::vector<RefineTask> tasks;
  for (auto& [key, members] : by_scale_and_bin(level, bins, candidates)) {
    if (deadline.over()) return false;
    const auto [scale, bin] = key;
    if (!at_scale.contains(scale)) at_scale.emplace(scale, level.at_scale(scale));
    tasks.push_back({scale, bin, &at_scale.at(scale), std::move(members), {}});
  }
  std::atomic<bool> complete{true};
  parallel_for(static_cast<int>(tasks.size()), level.threads, [&](int t) {
    if (deadline.over()) {
      complete = false;
    } else {
      run(tasks[static_cast<std::size_t>(t)], level, cells, ground, candidates);
    }
  });
  if (!complete) return false;
  candidates = best_of(tasks, std::move(candidates));
  return true;
}

Peak peak_around(const Level& level, const LatticePose& pose) {
  const LevelFeatures features = level.at_scale(pose.scale);
  const MapPlane plane(level.read(window_around(level, pose, kPeakRadius)).cells);
  std::vector<PlaneCell> places;
  add_places_around({plane.cols() / 2, plane.rows() / 2}, kPeakRadius, places);
  std::vector<MatchSums> sums(places.size());
  Peak peak;
  for (int d = 0; d < kPeakSize; ++d) {
    const PackedFootprint footprint =
        footprint_at(features.rotator, level.bins.heading(level.bins.wrapped(pose.bin + d - kPeakRadius)));
    match_sums(plane, footprint, places, sums);
    for (int row = 0; row < kPeakSize; ++row) {
      for (int col = 0; col < kPeakSize; ++col) {
        const auto at = static_cast<std::size_t>(row * kPeakSize + col);
        peak.scores[static_cast<std::size_t>(d)][static_cast<std::size_t>(row)][static_cast<std::size_t>(col)] =
            score_of(sums[at], features.full_cells, features.min_cells);
        if (d == kPeakRadius && row == kPeakRadius && col == kPeakRadius) peak.centre = sums[at];
      }
    }
  }
  return peak;
}

}  // namespace roadfix
