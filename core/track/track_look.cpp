#include "core/track/track_look.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/grid/resample.hpp"
#include "core/locate/match_poses.hpp"
#include "core/track/track_geometry.hpp"

namespace roadfix {
namespace {

constexpr LookAge kLookEvery{3'000'000, 45.0};
constexpr int kOpenLooks = 2;              // intervals after which a look that bore the place out is outdated
constexpr double kLookRadiusM = 60.0;      // less than a block, from which on streets repeat
constexpr double kMaxLookRadiusM = 150.0;  // after as long a flight since the last look: odometry may be all wrong
const Angle kLookHeading = Angle::degrees(15.0);
const Angle kNearHeading = Angle::degrees(3.0);  // corresponds to kNearM below
const Angle kMaxNearHeading = Angle::degrees(6.0);

constexpr double kSigmas = 2.0;  // of the belief, within which it counts as right

FeatureMap at_scale_of(const Cluster& belief, const FeatureMap& frame) {
  return resampled(frame, frame.cell_m, std::exp(belief.log_scale));
}

/// Probability of the poses within this distance and angle of a belief.
double probability_near(const Fix& fix, const Cluster& belief, const UtmZone& zone, double radius_m, Angle angle) {
  double near = 0.0;
  for (const FixMode& mode : fix.modes) {
    const GridPose pose = on_grid(mode.pose, zone);
    const bool is_near = distance_m(pose.position, belief.mean.position) <= radius_m &&
                         angular_distance(pose.heading, belief.mean.heading) <= angle;
    if (is_near) near += mode.weight;
  }
  return near;
}

/// Whether the frame fits nearly as well some way off, as along a road without crossings: which place on it the search
/// took then, is chance.
bool slides(const MapView& map, const FeatureMap& frame, const GridPose& pose) {
  constexpr double kApartM = 30.0;
  constexpr int kDirections = 36;  // less than the width of a road apart
  constexpr double kNearlyAsWell = 0.8;
  std::vector<PlaneCell> places{{0, 0}};
  for (int i = 0; i < kDirections; ++i) {
    const Angle direction = Angle::degrees(360.0 * i / kDirections);
    const double cells = kApartM / frame.cell_m;
    places.push_back(
        {static_cast<int>(std::lround(cells * sin(direction))), static_cast<int>(std::lround(cells * cos(direction)))});
  }
  const std::vector<MatchSums> sums = sums_beside(map, frame, pose, places);
  const double least = kNearlyAsWell * rho(sums.front()).value_or(0.0);
  return std::any_of(sums.begin() + 1, sums.end(), [&](const MatchSums& s) { return rho(s).value_or(0.0) >= least; });
}

Look::Outcome outcome_of(const Fix& fix, const Cluster& belief, const UtmZone& zone) {
  constexpr double kMinProbability = 0.5;  // a place that chance explains has no more
  constexpr double kMaxShareHere = 0.2;    // of the best place's probability, if the vehicle is elsewhere
  constexpr double kNearM = 15.0;
  constexpr double kMaxNearM = 30.0;  // for wide beliefs, or all that was searched would be near
  using Outcome = Look::Outcome;
  if (!fix.complete) return Outcome::kOpen;
  const double near_m = std::max(kNearM, kSigmas * belief.sigma_m());
  const Angle turned = std::max(kNearHeading, kSigmas * Angle::radians(std::sqrt(belief.covariance[2][2])));
  const double borne_out =
      probability_near(fix, belief, zone, std::min(near_m, kMaxNearM), std::min(turned, kMaxNearHeading));
  if (borne_out > kMinProbability) return Outcome::kBorneOut;
  const bool found = fix.status != FixStatus::kNoFix && fix.probability > kMinProbability;
  if (!found) return Outcome::kOpen;
  const double little = kMaxShareHere * fix.probability;
  if (probability_near(fix, belief, zone, near_m, kLookHeading) < little) return Outcome::kElsewhere;
  return probability_near(fix, belief, zone, near_m, turned) < little ? Outcome::kTurned : Outcome::kOpen;
}

}  // namespace

bool LookAge::is_due() const { return us >= kLookEvery.us || flown_m >= kLookEvery.flown_m; }

bool LookAge::is_outdated() const {
  return us >= kOpenLooks * kLookEvery.us || flown_m >= kOpenLooks * kLookEvery.flown_m;
}

bool fits_better_turned(const MapView& map, const FeatureMap& frame, const Cluster& belief) {
  const FeatureMap seen = at_scale_of(belief, frame);
  const auto rho = [&](Angle turn) {
    return rho_at(map, seen, {belief.mean.position, belief.mean.heading + turn}).value_or(0.0);
  };
  const double straight = rho({});
  const Angle sure = kSigmas * Angle::radians(std::sqrt(belief.covariance[2][2]));
  for (Angle turn = kNearHeading; turn <= kLookHeading; turn += kNearHeading) {
    if (turn > sure && std::max(rho(turn), rho(-turn)) > straight) return true;
  }
  return false;
}

LookArea LookArea::around(const GridPose& belief, double flown_m) {
  return {belief, std::clamp(flown_m, kLookRadiusM, kMaxLookRadiusM), kLookHeading};
}

LookArea LookArea::of(const Reach& reach, const LookArea& around) {
  return {{reach.position, reach.heading},
          std::max(reach.radius_m, around.radius_m),
          std::max(reach.turned_at_most(), around.heading_half_width)};
}

bool LookArea::covers(const Reach& reach) const {
  return distance_m(centre.position, reach.position) + reach.radius_m <= radius_m &&
         angular_distance(centre.heading, reach.heading) + reach.turned_at_most() <= heading_half_width;
}

std::optional<Prior> LookArea::prior(const MapView& map) const {
  return prior_near(map, centre, radius_m, heading_half_width);
}

Look look_around(const TrackSearch& search, const MapView& map, const FeatureMap& frame, const Cluster& belief,
                 const LookArea& area) {
  const std::optional<Prior> around = area.prior(map);
  if (!around) return {};
  const FeatureMap seen = at_scale_of(belief, frame);
  const std::optional<Fix> fix =
      search.find(seen, *around, {.looks_beyond_prior = false, .search = {.straight_roads = 1}});
  if (!fix) return {};
  Look look{outcome_of(*fix, belief, map.zone), {}};
  if (look.outcome == Look::Outcome::kBorneOut && slides(map, seen, on_grid(fix->modes.front().pose, map.zone))) {
    look.outcome = Look::Outcome::kOpen;
  }
  if (look.outcome == Look::Outcome::kElsewhere || look.outcome == Look::Outcome::kTurned) {
    look.places = proposals_of(map, *fix, seen);
    for (Proposal& place : look.places) place.log_scale += belief.log_scale;
  }
  return look;
}

}  // namespace roadfix
