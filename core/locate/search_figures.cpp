#include "core/locate/search_figures.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace roadfix {
namespace {

// Of a region without any rival, or with too few to tell how they thin out: chance may explain everything.
constexpr std::size_t kFewestRivals = 12;
constexpr double kUnknown = -10.0;
constexpr double kLargestFigure = 1000.0;

/// Differences between correlations near 1 mean more than the same near 0.
double fisher(double score) {
  constexpr double kPerfect = 0.9999;
  return std::atanh(std::clamp(score, -kPerfect, kPerfect));
}

/// Of the rivals' scores above the lowest of them.
double mean_excess(std::span<const double> rivals) {
  const double lowest = fisher(rivals.back());
  double sum = 0.0;
  for (const double score : rivals) sum += fisher(score) - lowest;
  return sum / static_cast<double>(rivals.size() - 1);
}

double ground_m2(const SearchMode& mode, double cell_m) {
  return static_cast<double>(mode.observed_cells) * cell_m * cell_m;
}

double second_of(const SearchResult& found) {
  const ScoreBackground& background = found.background;
  if (found.modes.size() > 1) return found.modes[1].score;
  if (!background.rivals_within.empty()) return background.rivals_within.front();
  return background.rivals.empty() ? found.modes.front().score : background.rivals.back();
}

}  // namespace

SearchFigures figures_of(const SearchResult& found) {
  assert(!found.modes.empty());
  const ScoreBackground& background = found.background;
  const double best = fisher(found.modes.front().score);
  const double ahead = best - fisher(second_of(found));
  const double ground = ground_m2(found.modes.front(), found.cell_m);
  SearchFigures figures;
  figures.surprise = kUnknown;
  figures.agreement = found.modes.front().pearson * std::sqrt(ground / kSampleM2);
  if (ground > 0.0) figures.other_roads_across = found.modes.front().other_roads_m / std::sqrt(ground);
  figures.ground = std::log(std::max(ground, 1.0));
  if (background.sd > 0.0) figures.lead = std::clamp(ahead / background.sd, 0.0, kLargestFigure);
  if (background.rivals.size() < kFewestRivals) return figures;
  const double scale = mean_excess(background.rivals);
  const double excess = best - fisher(background.rivals.back());
  if (scale <= 0.0 || excess <= 0.0) return figures;
  // The scale is itself an estimate from `count` values: the tail that follows falls as a power, not as exp.
  const auto count = static_cast<double>(background.rivals.size() - 1);
  const double log_expected = std::log(background.region_share * count) - count * std::log1p(excess / (scale * count));
  figures.surprise = std::clamp(-log_expected, kUnknown, kLargestFigure);
  figures.gap = std::clamp(ahead / scale, 0.0, kLargestFigure);
  return figures;
}

}  // namespace roadfix
