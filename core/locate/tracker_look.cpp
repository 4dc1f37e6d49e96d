// A track that is sure of its place looks around it from time to time, by a search that does not take the odometry's
// word. Where the odometry is worse than it says, the particles lag behind the vehicle: along a road, or by a block,
// frames still agree better there than by chance, so that nothing but a comparison with the places beside tells.
#include <algorithm>
#include <cmath>

#include "core/grid/resample.hpp"
#include "core/locate/track_geometry.hpp"
#include "core/locate/tracker_step.hpp"

namespace roadfix {
namespace {

constexpr std::int64_t kLookEveryUs = 3'000'000;
constexpr double kLookRadiusM = 60.0;  // less than a block, from which on streets repeat
const Angle kLookHeading = Angle::degrees(15.0);
constexpr double kMovedShare = 0.8;  // of the particles, to where it was found

/// Whether a search around a belief found the vehicle, but not there.
bool is_beside(const Fix& fix, const Cluster& belief, const UtmZone& zone) {
  constexpr double kMinProbability = 0.5;
  constexpr double kMinShare = 0.01;  // of the best mode's weight
  constexpr double kNearM = 15.0;
  constexpr double kSigmas = 2.0;
  if (fix.status == FixStatus::kNoFix || fix.probability < kMinProbability) return false;
  const double near_m = std::max(kNearM, kSigmas * belief.sigma_m());
  return std::ranges::none_of(fix.modes, [&](const FixMode& mode) {
    return mode.weight >= kMinShare * fix.modes.front().weight &&
           distance_m(on_grid(mode.pose, zone).position, belief.mean.position) <= near_m;
  });
}

}  // namespace

void Tracker::Step::look_around_if_due() {
  const bool sure = state_.claim.outweighs_chance() && state_.claim.confirmed;
  if (!settings_.recovers || !sure || estimate_.measurement == Measurement::kUseless) return;
  if (state_.looked_time_us && input_.time_us - *state_.looked_time_us < kLookEveryUs) return;
  state_.looked_time_us = input_.time_us;
  look_around();
}

void Tracker::Step::look_around() {
  const MapView& map = tracker_.map_;
  const Cluster belief = clusters_of(filter_.particles(), settings_.clusters).front();
  const auto around = prior_near(map, belief.mean, kLookRadiusM, kLookHeading);
  if (!around) return;
  const FeatureMap seen = resampled(*features_, features_->cell_m, std::exp(belief.log_scale));
  const std::optional<Fix> fix = search_for(seen, *around, {.looks_beyond_prior = false});
  if (!fix || !fix->complete || !is_beside(*fix, belief, map.zone)) return;
  state_.claim.reject();
  if (!state_.drifts && !coasts()) {
    state_.drifts = true;
    filter_.widen_drift(wind().sigma_m_s);
  }
  std::vector<Proposal> found = proposals_of(map, *fix, seen);
  for (Proposal& place : found) place.log_scale += belief.log_scale;
  filter_.inject(found, kMovedShare);
}

}  // namespace roadfix
