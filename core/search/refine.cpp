#include "core/search/refine.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <map>
#include <span>
#include <utility>

#include "core/match/footprint.hpp"
#include "core/match/kernel.hpp"
#include "core/match/score.hpp"
#include "core/search/ground_around.hpp"
#include "core/units/parallel_for.hpp"

namespace roadfix {
namespace {

/// Candidates that ask for the same scale and bin.
struct RefineTask {
  int quarters;  ///< of a turn from the heading of its family to the bin
  std::vector<std::size_t> candidates;
  std::vector<LatticePose> best;  ///< of each candidate
};

/// Tasks that share a feature map: turning it is expensive.
struct RefineFamily {
  const LevelFeatures* features;  ///< at the scale
  Angle heading;
  std::vector<RefineTask> tasks;
};

/// Indices of the candidates that ask for each (scale, bin).
using CandidatesOf = std::map<std::pair<int, int>, std::vector<std::size_t>>;

CandidatesOf by_scale_and_bin(const Level& level, int bins, const std::vector<LatticePose>& candidates) {
  CandidatesOf result;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (int scale = candidates[i].scale_step - 1; scale <= candidates[i].scale_step + 1; ++scale) {
      if (std::abs(scale) > level.scales.reach()) continue;
      for (int d = -bins; d <= bins; ++d) result[{scale, level.bins.wrapped(candidates[i].bin + d)}].push_back(i);
    }
  }
  return result;
}

/// Tasks by scale and, if the ground is kept in all four orientations, by bins that lie quarter turns apart.
std::vector<RefineFamily> families_of(const Level& level, const CandidatesOf& asked, bool by_quarters,
                                      const std::vector<LatticePose>& poses, std::map<int, LevelFeatures>& at_scale) {
  const int apart = by_quarters ? level.bins.count() / 4 : level.bins.count();
  std::map<std::pair<int, int>, RefineFamily> families;
  for (const auto& [key, candidates] : asked) {
    const auto [scale, bin] = key;
    if (!at_scale.contains(scale)) at_scale.emplace(scale, level.at_scale(scale));
    RefineTask task{bin / apart, candidates, {}};
    for (const std::size_t i : candidates) task.best.push_back({poses[i].cell, bin, 0.0, scale});
    const auto [family, is_new] = families.try_emplace(
        {scale, bin % apart}, RefineFamily{&at_scale.at(scale), level.bins.heading(bin % apart), {}});
    family->second.tasks.push_back(std::move(task));
  }
  std::vector<RefineFamily> result;
  for (auto& [key, family] : families) result.push_back(std::move(family));
  return result;
}

/// A cell to look at around a candidate of a task.
struct Neighbour {
  std::size_t member;
  LatticeIndex cell;
};

/// The cells around the best one of each candidate, without those within `seen` of where the candidate began.
std::vector<Neighbour> neighbours_beyond(int seen, const RefineTask& task, const std::vector<LatticePose>& poses) {
  std::vector<Neighbour> neighbours;
  for (std::size_t member = 0; member < task.best.size(); ++member) {
    const LatticeIndex begin = poses[task.candidates[member]].cell;
    const LatticeIndex best = task.best[member].cell;
    for (int row = best.row - 1; row <= best.row + 1; ++row) {
      for (int col = best.col - 1; col <= best.col + 1; ++col) {
        const bool beyond = std::max(std::abs(col - begin.col), std::abs(row - begin.row)) > seen;
        if (beyond) neighbours.push_back({member, {col, row}});
      }
    }
  }
  return neighbours;
}

void score_at(std::span<const Neighbour> neighbours, const GroundAround& ground, const PackedFootprint& footprint,
              const FootprintCells& full, RefineTask& task) {
  std::vector<std::size_t> poses;
  std::vector<LatticeIndex> cells;
  for (const Neighbour& each : neighbours) {
    poses.push_back(task.candidates[each.member]);
    cells.push_back(each.cell);
  }
  std::vector<MatchSums> sums(neighbours.size());
  ground.match(footprint, task.quarters, poses, cells, sums);
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    LatticePose& best = task.best[neighbours[k].member];
    const double score = score_of(sums[k], full);
    if (score <= best.score) continue;
    best.cell = cells[k];
    best.score = score;
  }
}

/// Goes uphill from each candidate. Since peaks are hardly narrower than a step, this mostly ends on the best of all
/// poses within reach, at half the cost.
void climb(RefineFamily& family, int cells, const GroundAround& ground, const std::vector<LatticePose>& poses) {
  const PackedFootprint footprint = footprint_at(family.features->rotator, family.heading);
  for (RefineTask& task : family.tasks) {
    constexpr int kNone = -1;
    score_at(neighbours_beyond(kNone, task, poses), ground, footprint, family.features->cells, task);
    for (int seen = 1; seen < cells; ++seen) {
      score_at(neighbours_beyond(seen, task, poses), ground, footprint, family.features->cells, task);
    }
  }
}

/// The best pose that any task found for each candidate.
std::vector<LatticePose> best_of(const std::vector<RefineFamily>& families, std::vector<LatticePose> candidates) {
  for (LatticePose& pose : candidates) pose.score = 0.0;
  for (const RefineFamily& family : families) {
    for (const RefineTask& task : family.tasks) {
      for (std::size_t k = 0; k < task.best.size(); ++k) {
        LatticePose& pose = candidates[task.candidates[k]];
        if (task.best[k].score > pose.score) pose = task.best[k];
      }
    }
  }
  return candidates;
}

}  // namespace

bool refine(const Level& level, RefineReach reach, const Deadline& deadline, std::vector<LatticePose>& candidates) {
  const CandidatesOf asked = by_scale_and_bin(level, reach.bins, candidates);
  const GroundAround ground(level, {.cells = reach.cells, .headings = static_cast<int>(asked.size())}, deadline,
                            candidates);
  if (!ground.complete()) return false;
  std::map<int, LevelFeatures> at_scale;
  std::vector<RefineFamily> families = families_of(level, asked, ground.rotated(), candidates, at_scale);
  std::atomic<bool> complete{true};
  parallel_for(static_cast<int>(families.size()), level.threads, [&](int i) {
    if (deadline.over()) {
      complete = false;
    } else {
      climb(families[static_cast<std::size_t>(i)], reach.cells, ground, candidates);
    }
  });
  if (!complete) return false;
  candidates = best_of(families, std::move(candidates));
  return true;
}

}  // namespace roadfix
