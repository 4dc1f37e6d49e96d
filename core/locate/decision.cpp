#include "core/locate/decision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace roadfix {
namespace {

// An agreement of this many standard deviations is not chance, even if many places of a regular city reach it.
constexpr double kBeyondChanceDeviations = 12.0;

// A surprise: the number of places that fit as well by chance is 0.01.
constexpr double kBeyondChance = 4.6;

// If the best place in the region is likelier than this, the answer does not say that it fits by chance, and a better
// place outside is mentioned.
constexpr double kLikely = 0.5;

// In sides of the footprint, beyond the border of the prior: the vehicle may be there if the prior is a little small.
constexpr double kJustOutsideSides = 0.5;

/// The likelihood of each mode over that of the best one.
std::vector<double> likelihood_ratios(const SearchResult& found) {
  const ScoreBackground& background = found.background;
  const double best = background.log_likelihood(found.modes.front().score);
  std::vector<double> ratios;
  for (const SearchMode& mode : found.modes) {
    ratios.push_back(std::exp(background.log_likelihood(mode.score) - best));
  }
  return ratios;
}

/// The best mode gets its probability, the others in proportion to their likelihoods, as far as that leaves room.
std::vector<double> weights_of(const std::vector<double>& ratios, double probability) {
  std::vector<double> weights;
  for (const double ratio : ratios) weights.push_back(probability * ratio);
  const double others = std::accumulate(weights.begin() + 1, weights.end(), 0.0);
  const double room = others > 1.0 - probability ? (1.0 - probability) / others : 1.0;
  for (std::size_t i = 1; i < weights.size(); ++i) weights[i] *= room;
  return weights;
}

std::string time_was_over(const SearchResult& found) {
  const char* advice = "give more time or a smaller region";
  if (found.scanned_share < 1.0) {
    return fmt::format(
        "the time limit ended the search after {:.0f} % of the poses, and a better one may be among the others: {}",
        std::floor(100.0 * found.scanned_share), advice);
  }
  return fmt::format("the time limit ended the search before the candidates were compared at full resolution: {}",
                     advice);
}

void explain(Decision& decision, const char* reason, std::string explanation) {
  decision.reason = reason;
  decision.explanation = std::move(explanation);
}

/// Whatever it has, it is no fix.
void explain_time_limit(Decision& decision, const SearchResult& found) {
  explain(decision, "search-time-limit", time_was_over(found));
}

std::string below_confidence(double probability, const Calibration& calibration, double confidence) {
  constexpr double kNearly = 0.95;
  if (confidence > calibration.highest && probability >= kNearly * calibration.highest) {
    return fmt::format(
        "the roads fit best at one place (probability {:.3f}), but the calibration vouches for no more than {:.4f} and "
        "a confidence of {} was asked for: ask for less, or learn a calibration from more queries",
        probability, calibration.highest, confidence);
  }
  return fmt::format(
      "the roads fit best at one place, but its probability ({:.3f}) is below the confidence asked for ({}): use a "
      "larger footprint or a narrower prior, or fly on and ask again",
      probability, confidence);
}

void call_ambiguous(Decision& decision, const std::vector<double>& ratios, const Calibration& calibration,
                    double confidence) {
  const auto alike = std::ranges::count_if(ratios, [](double ratio) { return ratio >= kModeShare; });
  decision.status = FixStatus::kAmbiguous;
  decision.weights.resize(static_cast<std::size_t>(alike));
  if (alike > 1) {
    explain(
        decision, "several-places-fit",
        fmt::format(
            "the roads fit about equally well at {} places: narrow the prior, give a heading, or fly on and ask again",
            alike));
  } else {
    explain(decision, "below-confidence", below_confidence(decision.probability, calibration, confidence));
  }
}

/// The UAV is not over the map, or what it sees looks like everywhere.
void explain_by_chance(Decision& decision, bool bare, std::string explanation) {
  if (bare) {
    explain(decision, "too-few-roads",
            "the frame shows less road than a single one across the footprint: use a larger footprint, or fly on to "
            "where roads are");
  } else {
    explain(decision, "not-above-chance", std::move(explanation));
  }
}

/// Side of a square as large as the ground that is compared at the best place.
double across_m(const SearchFigures& figures) { return std::exp(0.5 * figures.ground); }

std::string too_few_shared_roads(const SearchFigures& figures) {
  return fmt::format(
      "at the best place frame and map share {:.0f} m of road beside the longest straight ones, and {:.0f} m are "
      "needed, since junctions look alike: use a larger footprint, or fly on to where roads are; the UAV may not be "
      "over this map",
      figures.other_roads_across.value_or(0.0) * across_m(figures), kMinOtherRoadsAcross * across_m(figures));
}

/// Share of the best mode among itself and the places around the region.
double share_beside_outside(const SearchResult& found) {
  const ScoreBackground& background = found.background;
  const double best = background.log_likelihood(found.modes.front().score);
  double others = 0.0;
  for (const SearchMode& mode : found.outside) others += std::exp(background.log_likelihood(mode.score) - best);
  return 1.0 / (1.0 + others);
}

/// Whether the best place around the region fits better than chance explains.
bool is_known_outside(const SearchResult& found) {
  if (found.outside.empty()) return false;
  const std::span<const double> rivals(found.background.rivals);
  const auto others = rivals.subspan(std::min<std::size_t>(1, rivals.size()));  // all but itself
  return surprise_of(found.outside.front().score, others, 1.0) >= kBeyondChance;
}

std::string fits_outside(const SearchResult& found, const PoseRegion& region, const SearchFigures& figures) {
  const GridPoint outside = found.outside.front().pose.position;
  const double apart_m = distance_m(found.modes.front().pose.position, outside);
  if (region.grown(kJustOutsideSides * across_m(figures), {}).contains(outside)) {
    return fmt::format(
        "just outside of the prior, {:.0f} m from the best place in it, the roads fit as well or better: check the "
        "prior and its headings, or give a wider one",
        apart_m);
  }
  return fmt::format(
      "well outside of the prior, {:.0f} m from the best place in it, the roads fit as well or better: check the "
      "prior; if it is right, this ground repeats and no wider prior helps: use a larger footprint, or fly on and ask "
      "again",
      apart_m);
}

}  // namespace

Decision decide(const SearchResult& found, const PoseRegion& region, const Calibration& calibration, double confidence,
                bool bare) {
  Decision decision;
  if (found.modes.empty() && found.complete()) {
    explain(
        decision, "map-too-empty",
        "nowhere in the searched region do the roads fit at all, or the map has too little observed ground with roads "
        "there for this footprint: check the prior, widen it, or ingest more sources");
    return decision;
  }
  if (found.modes.empty()) {
    explain_time_limit(decision, found);
    return decision;
  }
  const SearchFigures figures = figures_of(found);
  decision.figures = figures;
  const std::vector<double> ratios = likelihood_ratios(found);
  const double within = found.scanned_share * calibration.probability(figures);
  const double share = share_beside_outside(found);
  decision.probability = share * within;
  decision.weights = weights_of(ratios, decision.probability);
  const bool few_roads = shares_too_few_roads(figures);
  const bool sure_within = !few_roads && within >= confidence;
  if (!found.complete()) {
    explain_time_limit(decision, found);
  } else if (!few_roads && decision.probability >= confidence) {
    decision.status = FixStatus::kFix;
  } else if (sure_within || (share < 0.5 && (within > kLikely || is_known_outside(found)))) {
    explain(decision, "better-outside-prior", fits_outside(found, region, figures));
  } else if (few_roads) {
    explain_by_chance(decision, bare, too_few_shared_roads(figures));
  } else if (figures.surprise >= kBeyondChance || figures.agreement >= kBeyondChanceDeviations) {
    call_ambiguous(decision, ratios, calibration, confidence);
  } else if (decision.probability > kLikely) {
    explain(decision, "below-confidence", below_confidence(decision.probability, calibration, confidence));
  } else {
    explain_by_chance(
        decision, bare,
        "the best place fits no better than chance allows among so many places: use a larger footprint or a "
        "narrower prior; the UAV may not be over this map, or its height or camera is told wrongly");
  }
  return decision;
}

}  // namespace roadfix
