// The searches of a track: where it begins, and where its belief has to be told from other places or found again.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "core/locate/track_geometry.hpp"
#include "core/locate/tracker_step.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr std::int64_t kMeasurementsBetweenSearches = 10;
constexpr std::int64_t kMeasurementsBeforeClaim = 5;  // likewise, where a claim waits for a search
constexpr double kProbabilityForClaim = 0.95;         // of a search at the place that the measurements bear out
constexpr double kInjectedShare = 0.3;
constexpr double kMaxFixShare = 0.9;  // of the particles; the others begin anew
constexpr double kRecoveryRadiusM = 3000.0;
constexpr double kMaxRivalShare = 0.3;      // of the weight of the place
constexpr double kUntoldScaleRange = 0.15;  // of altitudes that are taken for exact, before a fix is believed

}  // namespace

bool Tracker::Step::may_search() const { return settings_.recovers || settings_.start == TrackStart::kSearch; }

/// The prior as it was given holds for the first step only. False where the particles stay as they are.
bool Tracker::Step::start_by_search() {
  const bool first = state_.sequence < 0;
  const std::optional<Prior> prior = first ? settings_.prior : prior_around(tracker_.map_, filter_.particles());
  if (!prior) return false;
  state_.searched = true;
  const FeatureMap seen = state_.recent.laid_around(*features_);
  const std::optional<Fix> fix = search_within(*prior, seen);
  if (!fix || fix->modes.empty()) return false;
  double known = 0.0;
  for (const FixMode& mode : fix->modes) known += mode.weight;
  filter_.restart_from(proposals_of(tracker_.map_, *fix, *features_), std::clamp(1.0 - known, 1.0 - kMaxFixShare, 0.9),
                       first ? tracker_.start_ : tracker_.region_.poses);
  estimate_.measurement = Measurement::kSearched;
  if (fix->status == FixStatus::kFix && holds_at_other_scales(*fix, *prior, seen)) confirm(*fix);
  return true;
}

void Tracker::Step::search_if_due() {
  const bool claim_waits = state_.claim.outweighs_chance() && !state_.claim.confirmed;
  const std::int64_t wait = claim_waits ? kMeasurementsBeforeClaim : kMeasurementsBetweenSearches;
  if (settings_.recovers && wants_search() && state_.measured - state_.last_search >= wait) recover();
}

bool Tracker::Step::wants_search() const {
  // Nothing has spoken for the belief for long, be it that nothing could.
  const bool stale = since_accepted_s().value_or(0.0) >= kStaleAfterS;
  if (filter_.doubt() > kMaxDoubt || stale) return true;
  if (state_.claim.outweighs_chance()) return !state_.claim.confirmed;
  return state_.claim.log_odds == 0.0 && estimate_.measurement != Measurement::kUseless;
}

void Tracker::Step::recover() {
  const GridPose believed = clusters_of(filter_.particles(), settings_.clusters).front().mean;
  const FeatureMap seen = state_.recent.laid_around(*features_);
  Prior prior;
  std::optional<Fix> fix = search_within(prior, seen);
  if (!fix) {
    prior.circle = GeoCircle{tracker_.map_.zone.unproject(believed.position), kRecoveryRadiusM};
    fix = search_within(prior, seen);
  }
  if (!fix || fix->modes.empty()) return;
  const bool agrees = is_same_place(on_grid(fix->modes.front().pose, tracker_.map_.zone), believed);
  if (agrees && fix->probability >= kProbabilityForClaim) {
    state_.claim.confirmed = holds_at_other_scales(*fix, prior, seen);
  } else if (fix->status != FixStatus::kFix || !holds_at_other_scales(*fix, prior, seen)) {
    filter_.inject(proposals_of(tracker_.map_, *fix, *features_), kInjectedShare);
  } else {
    filter_.start_from(proposals_of(tracker_.map_, *fix, *features_), 1.0 - kMaxFixShare, tracker_.region_.poses);
    estimate_.measurement = Measurement::kSearched;
    forget_support();
    state_.searched = true;
    confirm(*fix);
  }
}

/// Whether the place has no rival where the ground may be of another size than the frames say. From a wrong altitude
/// the streets of one quarter look like those of another whose blocks are as much smaller, and no frame contradicts it.
bool Tracker::Step::holds_at_other_scales(const Fix& fix, const Prior& prior, const FeatureMap& seen) {
  if (settings_.vehicle.scale_range >= kUntoldScaleRange) return true;
  const std::optional<Fix> other =
      search_for(seen, prior, {.scale_range = kUntoldScaleRange, .looks_beyond_prior = false});
  if (!other || !other->complete) return false;
  const GridPose place = on_grid(fix.modes.front().pose, tracker_.map_.zone);
  double here = 0.0;
  double elsewhere = 0.0;
  for (const FixMode& mode : other->modes) {
    double& weight = is_same_place(on_grid(mode.pose, tracker_.map_.zone), place) ? here : elsewhere;
    weight = std::max(weight, mode.weight);
  }
  return elsewhere < kMaxRivalShare * here;
}

void Tracker::Step::confirm(const Fix& fix) {
  state_.claim.confirm(fix.probability);
  state_.accepted_time_us = input_.time_us;
  state_.looked_time_us.reset();  // the next frame tells whether the odometry carries the place on rightly
  doubt_odometry();
}

/// nullopt also where the time was over first: a flight goes on without a search, as it would be stuck with a map that
/// takes longer. At its beginning that is an error, as a smaller prior helps.
std::optional<Fix> Tracker::Step::search_within(const Prior& prior, const FeatureMap& seen) {
  state_.last_search = state_.measured;
  std::optional<Fix> fix =
      search_for(seen, prior, {.scale_range = settings_.vehicle.scale_range, .own_frame = features_});
  if (!fix || fix->complete) return fix;
  // What it has depends on the machine, and a track must come out the same.
  if (state_.sequence < 0) throw Interrupted("search-time-limit", fix->explanation);
  return std::nullopt;
}

/// nullopt where the area is beyond the limit.
std::optional<Fix> Tracker::Step::search_for(const FeatureMap& features, const Prior& prior, FixOptions options) {
  options.max_search_km2 = settings_.max_search_km2;
  options.threads = limits_.threads;
  if (limits_.searches_end) {
    const auto left = *limits_.searches_end - std::chrono::steady_clock::now();
    options.time_limit = std::max(std::chrono::ceil<std::chrono::milliseconds>(left), std::chrono::milliseconds(0));
  }
  options.stop = limits_.stop;
  options.calibration = settings_.calibration;
  try {
    return locate(tracker_.map_, features, prior, options);
  } catch (const LimitExceeded&) {
    return std::nullopt;
  }
}

}  // namespace roadfix
