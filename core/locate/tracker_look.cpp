// A track that is sure of its place looks around it from time to time, by a search that does not take the odometry's
// word. Where the odometry is worse than it says, the particles lag behind the vehicle: along a road, or by a block,
// frames still agree better there than by chance, so that nothing but a comparison with the places beside tells. Only a
// place that such looks bear out is claimed.
#include <algorithm>
#include <cmath>

#include "core/grid/resample.hpp"
#include "core/locate/track_geometry.hpp"
#include "core/locate/tracker_step.hpp"

namespace roadfix {
namespace {

constexpr std::int64_t kLookEveryUs = 3'000'000;
constexpr double kLookEveryM = 45.0;
constexpr int kOpenLooks = 2;              // times as old a look that bore the place out may be
constexpr double kLookRadiusM = 60.0;      // less than a block, from which on streets repeat
constexpr double kMaxLookRadiusM = 150.0;  // where as much was flown since the last look: odometry may be all wrong
const Angle kLookHeading = Angle::degrees(15.0);
constexpr double kMovedShare = 0.8;  // of the particles, to where it was found

enum class Outcome { kBorneOut, kBeside, kOpen };

/// Probability of the places within this distance of a belief.
double probability_near(const Fix& fix, const Cluster& belief, const UtmZone& zone, double radius_m) {
  double near = 0.0;
  for (const FixMode& mode : fix.modes) {
    if (distance_m(on_grid(mode.pose, zone).position, belief.mean.position) <= radius_m) near += mode.weight;
  }
  return near;
}

/// What a search around a belief says of it.
Outcome outcome_of(const Fix& fix, const Cluster& belief, const UtmZone& zone) {
  constexpr double kMinProbability = 0.5;
  constexpr double kMaxShareBeside = 0.2;  // of the best place's probability
  constexpr double kNearM = 15.0;
  constexpr double kMaxNearM = 30.0;  // however wide the belief: all that was searched lies near it then
  constexpr double kSigmas = 2.0;
  if (!fix.complete) return Outcome::kOpen;
  const double near_m = std::max(kNearM, kSigmas * belief.sigma_m());
  if (probability_near(fix, belief, zone, std::min(near_m, kMaxNearM)) >= kMinProbability) return Outcome::kBorneOut;
  const bool found = fix.status != FixStatus::kNoFix && fix.probability >= kMinProbability;
  const bool beside = found && probability_near(fix, belief, zone, near_m) < kMaxShareBeside * fix.probability;
  return beside ? Outcome::kBeside : Outcome::kOpen;
}

}  // namespace

void Tracker::Step::look_around_if_due() {
  const bool sure = state_.claim.outweighs_chance() && state_.claim.confirmed;
  if (!settings_.recovers || !sure || estimate_.measurement == Measurement::kUseless) return;
  if (is_look_older_than(kLookEveryUs, kLookEveryM)) look_around();
}

bool Tracker::Step::is_look_older_than(std::int64_t us, double flown_m) const {
  return !state_.looked_time_us || input_.time_us - *state_.looked_time_us >= us || flown_since_look_m() >= flown_m;
}

double Tracker::Step::flown_since_look_m() const {
  const std::int64_t since_us = input_.time_us - state_.looked_time_us.value_or(state_.time_us);
  return 1e-6 * static_cast<double>(since_us) * speed_m_s();
}

void Tracker::Step::look_around() {
  const MapView& map = tracker_.map_;
  const Cluster belief = clusters_of(filter_.particles(), settings_.clusters).front();
  const double radius_m = std::clamp(flown_since_look_m(), kLookRadiusM, kMaxLookRadiusM);
  const auto around = prior_near(map, belief.mean, radius_m, kLookHeading);
  if (!around) return;
  const FeatureMap seen = resampled(*features_, features_->cell_m, std::exp(belief.log_scale));
  const std::optional<Fix> fix = search_for(seen, *around, {.looks_beyond_prior = false});
  if (!fix) return;
  switch (outcome_of(*fix, belief, map.zone)) {
    case Outcome::kBorneOut:
      state_.looked_time_us = input_.time_us;
      doubt_odometry();
      break;
    case Outcome::kOpen:
      if (is_look_older_than(kOpenLooks * kLookEveryUs, kOpenLooks * kLookEveryM)) state_.looked_time_us.reset();
      break;
    case Outcome::kBeside:
      state_.looked_time_us.reset();
      move_beside(*fix, seen, belief.log_scale);
  }
}

void Tracker::Step::move_beside(const Fix& fix, const FeatureMap& seen, double log_scale) {
  state_.claim.reject();
  if (!state_.drifts && !coasts()) {
    state_.drifts = true;
    filter_.widen_drift(wind().sigma_m_s);
  }
  std::vector<Proposal> found = proposals_of(tracker_.map_, fix, seen);
  for (Proposal& place : found) place.log_scale += log_scale;
  filter_.inject(found, kMovedShare);
}

}  // namespace roadfix
