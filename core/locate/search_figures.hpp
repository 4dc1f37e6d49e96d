// How far the best place of a search stands out, in figures that mean the same for every map, footprint and region:
// distances between scores, in units of the spread of the scores of that search.
#pragma once

#include <optional>
#include <span>

#include "core/search/search.hpp"

namespace roadfix {

/// Ground that counts as one independent sample: cells within about 15 m, the width of a wide road, err together. Only
/// a unit, in which thresholds were chosen, and the samples of tracks (MeasurementModel::most_samples).
inline constexpr double kSampleM2 = 15.0 * 15.0;

/// Least SearchFigures::other_roads_across of a place. One straight road looks like every other, and so does a junction
/// of straight ones: T, X and L have nothing but their two longest lines, a small roundabout less than 0.3 beyond them.
/// With less than this a place is explained by chance, whatever its lead: where few cells are road, the scores of other
/// places do not tell how often those few fit. The third arm of a Y is up to 0.6, but two of them must also agree in
/// their angles; no wrong place in simulations had more than 0.26 (docs/calibration-history.md).
inline constexpr double kMinOtherRoadsAcross = 0.4;

struct SearchFigures {
  /// -ln of how many places of the region fit as well as the best one by chance, if the scores of its rivals, in
  /// Fisher's z, have an exponential tail above the lowest of them (Gumbel's domain of attraction). Large = chance does
  /// not explain it.
  double surprise = 0.0;
  /// Fisher's z of the best place minus that of the next distinct one in the region (where there is none, of the lowest
  /// around it), in standard deviations of the scores of all scanned poses. Large = no other place explains it.
  double lead = 0.0;
  /// The same distance in mean excesses of that tail. By chance it is about exponential with mean 1.
  double gap = 0.0;
  /// Pearson's correlation at the best place in standard deviations of independent samples, whatever other places have.
  double agreement = 0.0;
  /// ln of the ground in m2 that was compared at the best place. The less it is, the more places fit by chance and the
  /// less the tail of the others tells of that.
  double ground = 0.0;
  /// SearchResult::other_roads_m over the side of a square as large as the ground compared; nullopt if unknown.
  std::optional<double> other_roads_across{};
};

/// Less than kMinOtherRoadsAcross, or unknown: chance explains the best place.
bool shares_too_few_roads(const SearchFigures& figures);

/// SearchFigures::surprise of a place of this score. `rivals` and `region_share` as of ScoreBackground.
double surprise_of(double score, std::span<const double> rivals, double region_share);

/// `found` has a mode at least.
SearchFigures figures_of(const SearchResult& found);

}  // namespace roadfix
