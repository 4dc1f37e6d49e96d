#include "core/locate/search_figures.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace roadfix {
namespace {

// With fewer rivals their tail is unknown, and chance may explain everything.
constexpr std::size_t kFewestRivals = 12;
constexpr double kUnknown = -10.0;
constexpr double kLargestFigure = 1000.0;

/// Differences between correlations near 1 mean more than the same near 0.
double fisher(double score) {
  constexpr double kPerfect = 0.9999;
  return std::atanh(std::clamp(score, -kPerfect, kPerfect));
}

/// Of the rivals' scores above the lowest one, in Fisher's z.
double mean_excess(std::span<const double> rivals) {
  const double lowest = fisher(rivals.back());
  double sum = 0.0;
  for (const double score : rivals) sum += fisher(score) - lowest;
  return sum / static_cast<double>(rivals.size() - 1);
}

/// The mean excess of rivals above the lowest one, and that of the place itself, both in Fisher's z.
struct Tail {
  double mean_excess;
  double excess;
};

/// nullopt where the rivals are too few to tell, or the place is not above them.
std::optional<Tail> tail_below(double score, std::span<const double> rivals) {
  if (rivals.size() < kFewestRivals) return std::nullopt;
  const Tail tail{mean_excess(rivals), fisher(score) - fisher(rivals.back())};
  if (tail.mean_excess <= 0.0 || tail.excess <= 0.0) return std::nullopt;
  return tail;
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

bool shares_too_few_roads(const SearchFigures& figures) {
  return !(figures.other_roads_across >= kMinOtherRoadsAcross);
}

double surprise_of(double score, std::span<const double> rivals, double region_share) {
  const std::optional<Tail> tail = tail_below(score, rivals);
  if (!tail) return kUnknown;
  // The scale is itself an estimate from `count` values: the tail that follows falls as a power, not as exp.
  const auto count = static_cast<double>(rivals.size() - 1);
  const double log_expected =
      std::log(region_share * count) - count * std::log1p(tail->excess / (tail->mean_excess * count));
  return std::clamp(-log_expected, kUnknown, kLargestFigure);
}

SearchFigures figures_of(const SearchResult& found) {
  assert(!found.modes.empty());
  const ScoreBackground& background = found.background;
  const double score = found.modes.front().score;
  const double ahead = fisher(score) - fisher(second_of(found));
  const double ground = ground_m2(found.modes.front(), found.cell_m);
  SearchFigures figures;
  figures.surprise = surprise_of(score, background.rivals, background.region_share);
  figures.agreement = found.modes.front().pearson * std::sqrt(ground / kSampleM2);
  if (found.other_roads_m && ground > 0.0) figures.other_roads_across = *found.other_roads_m / std::sqrt(ground);
  figures.ground = std::log(std::max(ground, 1.0));
  if (background.sd > 0.0) figures.lead = std::clamp(ahead / background.sd, 0.0, kLargestFigure);
  if (const auto tail = tail_below(score, background.rivals)) {
    figures.gap = std::clamp(ahead / tail->mean_excess, 0.0, kLargestFigure);
  }
  return figures;
}

}  // namespace roadfix
