#include "core/match/refine.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <span>
#include <utility>

#include "core/match/footprint.hpp"
#include "core/match/ground_around.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// Candidates that ask for the same scale and bin: turning the feature map is expensive, so they share it.
struct RefineTask {
  int scale;
  int bin;
  const LevelFeatures* features;
  std::vector<std::size_t> candidates;
  std::vector<LatticePose> best;  ///< of each candidate
};

/// The best of the poses around a candidate; `sums` are theirs, in the order of places_around().
LatticePose best_around(LatticeIndex cell, int cells, const RefineTask& task, std::span<const MatchSums> sums) {
  LatticePose best{cell, task.bin, 0.0, task.scale};
  const int width = 2 * cells + 1;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const double score = score_of(sums[k], task.features->cells);
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
  for (const std::size_t i : task.candidates) {
    const std::vector<PlaneCell> around = places_around(ground.place(i, poses[i].cell), cells);
    places.insert(places.end(), around.begin(), around.end());
  }
  std::vector<MatchSums> sums(places.size());
  ground.match(footprint, task.candidates, places, sums);
  const std::size_t each = places.size() / task.candidates.size();
  for (std::size_t k = 0; k < task.candidates.size(); ++k) {
    task.best.push_back(
        best_around(poses[task.candidates[k]].cell, cells, task, std::span(sums).subspan(k * each, each)));
  }
}

}  // namespace

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

}  // namespace roadfix
