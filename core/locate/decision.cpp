#include "core/locate/decision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadfix {
namespace {

constexpr double kChanceSafety = 10.0;
constexpr std::size_t kFewestRivals = 12;

// Cells within about 15 m of each other err together (a road is as wide): so much ground counts as one sample. An
// agreement of this many standard deviations is not chance, even where all places of a regular city reach it.
constexpr double kSampleM2 = 15.0 * 15.0;
constexpr double kBeyondChance = 12.0;

/// Fisher's z: differences between correlations near 1 mean more than the same near 0.
double fisher(double score) {
  constexpr double kPerfect = 0.9999;
  return std::atanh(std::clamp(score, -kPerfect, kPerfect));
}

double deviations(const SearchMode& mode, double cell_m) {
  const double samples = static_cast<double>(mode.observed_cells) * cell_m * cell_m / kSampleM2;
  return mode.pearson * std::sqrt(samples);
}

/// Shares of the posterior of the modes, all places of the region considered.
std::vector<double> shares(const SearchResult& found) {
  const ScoreBackground& background = found.background;
  const double best = background.log_likelihood(found.modes.front().score);
  double total = 0.0;
  std::vector<double> result;
  for (const SearchMode& mode : found.modes) {
    result.push_back(std::exp(background.log_likelihood(mode.score) - best));
    total += result.back();
  }
  for (std::size_t i = found.modes.size() - 1; i < background.rivals_within.size(); ++i) {
    total += std::exp(background.log_likelihood(background.rivals_within[i]) - best);
  }
  for (double& share : result) share /= total;
  return result;
}

}  // namespace

double expected_by_chance(double best_score, const ScoreBackground& background) {
  const std::vector<double>& rivals = background.rivals;
  if (rivals.size() < kFewestRivals) return std::numeric_limits<double>::infinity();
  const double lowest = fisher(rivals.back());
  const auto count = static_cast<double>(rivals.size() - 1);
  double mean_excess = 0.0;
  for (const double score : rivals) mean_excess += (fisher(score) - lowest) / count;
  const double excess = fisher(best_score) - lowest;
  if (mean_excess <= 0.0 || excess <= 0.0) return std::numeric_limits<double>::infinity();
  // The mean excess is itself an estimate from `count` values: the tail that follows falls as a power, not as exp.
  const double tail = std::pow(1.0 + excess / (mean_excess * count), -count);
  return background.region_share * count * tail;
}

Decision decide(const SearchResult& found, double confidence) {
  Decision decision;
  if (found.modes.empty()) {
    decision.reason = "map-too-empty";
    decision.explanation =
        "nowhere in the searched region does the map hold enough observed ground with roads under the footprint: widen "
        "the region or ingest more sources";
    return decision;
  }
  const SearchMode& best = found.modes.front();
  const double above_chance = std::exp(-kChanceSafety * expected_by_chance(best.score, found.background));
  decision.weights = shares(found);
  for (double& weight : decision.weights) weight *= above_chance;
  decision.probability = decision.weights.front();
  if (decision.probability >= confidence) {
    decision.status = FixStatus::kFix;
  } else if (above_chance >= confidence || deviations(best, found.cell_m) >= kBeyondChance) {
    decision.status = FixStatus::kAmbiguous;
    decision.reason = "several-places-fit";
    decision.explanation = fmt::format(
        "the roads fit at {} places about as well: narrow the prior, give a heading, or fly on and ask again",
        std::max<std::size_t>(2, found.modes.size()));
  } else {
    decision.reason = "not-above-chance";
    decision.explanation =
        "the best place fits no better than chance would have it among so many: use a larger footprint or a narrower "
        "prior, or the UAV is not over this map";
  }
  return decision;
}

}  // namespace roadfix
