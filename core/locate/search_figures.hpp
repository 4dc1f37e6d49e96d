// What a search says about its own best place, in figures that mean the same for every map, footprint and region:
// distances between scores in units of the spread that the scores of this very search have.
#pragma once

#include <optional>
#include <span>

#include "core/search/search.hpp"

namespace roadfix {

/// Cells within about 15 m of each other err together (a road is as wide): so much ground counts as one sample. A unit
/// for the thresholds that were set in it. The filter of tracks multiplies the evidence of its samples, where too many
/// make it sure too early, and counts more ground as one (MeasurementModel::independent_m2).
inline constexpr double kSampleM2 = 15.0 * 15.0;

/// One straight road looks like every other, and so does a junction of straight roads: beside its two longest lines,
/// all that T, X and L have, nothing is left, and of a small roundabout less than 0.3. A place needs more. Else it is
/// explained by chance, however far it is ahead: where few cells are road, the scores of other places say nothing of
/// how often those few fit. The third arm of a Y is up to 0.6; but two of those agree in their angles, too, and no
/// wrong place that was drawn kept more than 0.26 (docs/calibration-history.md).
inline constexpr double kMinOtherRoadsAcross = 0.4;

struct SearchFigures {
  /// -ln of how many places of the region would fit as well as the best one by chance, if the scores of the distinct
  /// places beside it thin out like an exponential tail of Fisher's z above the lowest of them (the domain of
  /// attraction of Gumbel). Large = chance does not explain it.
  double surprise = 0.0;
  /// Fisher's z of the best place minus that of the next distinct one in the region (where there is none, of the lowest
  /// around it), in standard deviations of the scores of all scanned poses. Large = no other place explains it.
  double lead = 0.0;
  /// The same distance in mean excesses of that tail. Of chance alone it is about exponential with mean 1.
  double gap = 0.0;
  /// Pearson's correlation at the best place in standard deviations of independent samples: of itself, whatever the
  /// other places say.
  double agreement = 0.0;
  /// ln of the ground in m2 that took part at the best place. The fewer the samples, the more by chance fits well and
  /// the less the tail of the others says of it.
  double ground = 0.0;
  /// Road in both that the best place rests on beside the longest straight lines among it: its length over the side
  /// of a square as large as the ground that took part; nullopt where that is unknown.
  std::optional<double> other_roads_across{};
};

/// So few, or unknown, that chance explains the best place (kMinOtherRoadsAcross).
bool shares_too_few_roads(const SearchFigures& figures);

/// SearchFigures::surprise of a place of this score among these rivals (ScoreBackground::rivals), where the region has
/// such a share of the ground that they came from.
double surprise_of(double score, std::span<const double> rivals, double region_share);

/// `found` holds a mode.
SearchFigures figures_of(const SearchResult& found);

}  // namespace roadfix
