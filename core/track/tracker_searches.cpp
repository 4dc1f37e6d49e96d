// What a step does with searches: begin the track, rule out other places than the belief, and find the vehicle again.
#include <algorithm>
#include <cstdint>

#include "core/locate/other_places.hpp"
#include "core/track/track_geometry.hpp"
#include "core/track/tracker_step.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr std::int64_t kMeasurementsBetweenSearches = 10;
constexpr std::int64_t kMeasurementsBeforeClaim = 5;  // likewise, while a claim waits for a search
constexpr std::int64_t kMeasurementsWithinReach = 2;  // likewise, before the vehicle is out of reach of what is known
constexpr double kProbabilityForClaim = 0.95;         // of a search that found the believed place
constexpr double kProbabilityElsewhere = 0.5;         // of a search that contradicts a known start
constexpr double kLeastShareOfBest = 0.85;            // of the agreement there, by the place within reach
constexpr double kInjectedShare = 0.3;
constexpr double kMovedShare = 0.8;   // of the particles, to where a look found the vehicle
constexpr double kMaxFixShare = 0.9;  // of the particles; the others begin anew
// Of the time that a step has left. The rest is for the check at other scales.
constexpr double kWholeMapTimeShare = 0.3;
constexpr double kAroundTimeShare = 0.5;
constexpr double kHereTimeShare = 0.5;

double probability_of_all(const Fix& fix) {
  double known = 0.0;
  for (const FixMode& mode : fix.modes) known += mode.weight;
  return known;
}

}  // namespace

bool Tracker::Step::may_search() const { return settings_.recovers || settings_.start == TrackStart::kSearch; }

/// The prior of the track holds for the first step only. False if the particles were left as they are.
bool Tracker::Step::start_by_search() {
  const std::optional<Prior> prior = is_first() ? settings_.prior : prior_around(map_, filter_.particles());
  if (!prior) return false;
  state_.searched = true;
  const FeatureMap seen = state_.recent.laid_around(*features_);
  const std::optional<Fix> fix = search_within(*prior, seen, 1.0);
  if (!fix || fix->modes.empty()) return false;
  const double uniform_share = std::clamp(1.0 - probability_of_all(*fix), 1.0 - kMaxFixShare, 0.9);
  filter_.redraw_from(proposals_of(map_, *fix, *features_), uniform_share,
                      is_first() ? tracker_.start_ : tracker_.region_.poses);
  outcome_.measurement = Measurement::kSearched;
  if (fix->status == FixStatus::kFix && search_.holds_at_other_scales(*fix, seen, *prior)) {
    confirm(*fix);
    // That nothing else is likely within a known start does not say that the start is right.
    if (begins_known()) state_.claim.set_confirmed(false);
  }
  return true;
}

void Tracker::Step::look_around_if_due() {
  if (!settings_.recovers || !state_.claim.is_told_apart() || outcome_.measurement == Measurement::kUseless) return;
  const std::int64_t since_us = input_.time_us - state_.claim.looked_time_us.value_or(input_.time_us);
  const LookAge last{since_us, state_.claim.flown_m};
  const Cluster belief = heaviest_of(filter_.particles());
  const LookArea area = look_area(belief.mean);
  const bool due = !state_.claim.looked_time_us || last.is_due();
  if (!due && !fits_better_turned(map_, *features_, belief)) return;
  take(look_around(search_, map_, *features_, belief, area), last);
}

/// Where the vehicle may be beyond what looks cover by themselves, all of that: no search has ruled it out.
LookArea Tracker::Step::look_area(const GridPose& believed) const {
  const LookArea area = LookArea::around(believed, state_.claim.flown_m);
  return state_.reach && !area.covers(*state_.reach) ? LookArea::of(*state_.reach, area) : area;
}

void Tracker::Step::take(const Look& look, LookAge last) {
  switch (look.outcome) {
    case Look::Outcome::kBorneOut:
      state_.claim.bear_out(input_.time_us);
      hold(heaviest_of(filter_.particles()).mean);
      motion_.try_drifts(filter_);
      break;
    case Look::Outcome::kOpen:
      if (last.is_outdated()) state_.claim.forget_look();
      break;
    case Look::Outcome::kElsewhere:
      motion_.learn_drift(filter_);
      [[fallthrough]];
    case Look::Outcome::kTurned:
      state_.claim.reject();
      filter_.inject(look.places, kMovedShare);
  }
}

void Tracker::Step::search_if_due() {
  const std::int64_t before_claim = state_.reach ? kMeasurementsWithinReach : kMeasurementsBeforeClaim;
  const std::int64_t wait = state_.claim.waits_for_search() ? before_claim : kMeasurementsBetweenSearches;
  if (settings_.recovers && wants_search() && state_.measured - state_.last_search >= wait) recover();
}

bool Tracker::Step::wants_search() const {
  // Nothing has supported the belief for long, be it that nothing could.
  const bool stale = state_.since_accepted_s(input_.time_us).value_or(kStaleAfterS) >= kStaleAfterS;
  if (filter_.doubt() > kMaxDoubt || stale) return true;
  return state_.claim.waits_for_search() ||
         (state_.claim.log_odds == 0.0 && outcome_.measurement != Measurement::kUseless);
}

void Tracker::Step::recover() {
  const GridPose believed = heaviest_of(filter_.particles()).mean;
  const FeatureMap seen = state_.recent.laid_around(*features_);
  Prior prior;
  std::optional<Fix> fix = search_within(prior, seen, kWholeMapTimeShare);
  if (!fix) {
    prior.circle = GeoCircle{map_.zone.unproject(believed.position), TrackSearch::kAroundM};
    fix = search_within(prior, seen, kAroundTimeShare);
  }
  if (!fix || fix->modes.empty()) return;
  const bool is_sure = confirms(*fix, believed) || fix->status == FixStatus::kFix;
  const bool holds = is_sure && search_.holds_at_other_scales(*fix, seen, prior);
  if (state_.reach && !holds) return rely_on_reach(*fix, seen, believed);
  settle(*fix, holds, prior, believed);
}

/// A search of the whole map was not sure: what lies beyond reach need not be ruled out, and looks rule out what lies
/// within it. Nothing is claimed where the roads fit far better elsewhere (the start was not where it was said to be,
/// or the odometry is all wrong), nor at another size of the ground; nor beyond reach, where particles are drawn, too.
void Tracker::Step::rely_on_reach(const Fix& anywhere, const FeatureMap& seen, const GridPose& believed) {
  const std::optional<Prior> near = LookArea::around(believed, 0.0).prior(map_);
  if (!near || !state_.reach->holds(believed)) return state_.claim.reopen();
  const std::optional<Fix> here =
      search_.find(seen, *near, {.looks_beyond_prior = false, .search = {.scale_range = settings_.vehicle.scale_range}},
                   kHereTimeShare);
  if (!here || !here->complete || here->modes.empty() || !is_at(believed, here->modes.front())) {
    return state_.claim.reopen();
  }
  const FixMode& best = anywhere.modes.front();
  const bool fits_elsewhere = !is_at(believed, best) && (anywhere.probability > kProbabilityElsewhere ||
                                                         here->modes.front().rho < kLeastShareOfBest * best.rho);
  state_.claim.set_confirmed(!fits_elsewhere && search_.holds_at_other_scales(*here, seen, *near));
}

bool Tracker::Step::is_at(const GridPose& believed, const FixMode& mode) const {
  return is_same_place(on_grid(mode.pose, map_.zone), believed);
}

bool Tracker::Step::confirms(const Fix& fix, const GridPose& believed) const {
  return fix.probability >= kProbabilityForClaim && is_at(believed, fix.modes.front());
}

/// `holds`: the search is sure of its best place, at whatever size of the ground.
void Tracker::Step::settle(const Fix& fix, bool holds, const Prior& prior, const GridPose& believed) {
  if (confirms(fix, believed)) {
    state_.claim.set_confirmed(holds);
    if (holds) hold(on_grid(fix.modes.front().pose, map_.zone));
  } else if (!holds) {
    filter_.inject(proposals_of(map_, fix, *features_), kInjectedShare);
    state_.claim.reopen();
  } else {
    filter_.start_anew_from(proposals_of(map_, fix, *features_), 1.0 - kMaxFixShare, region_of(map_, prior));
    outcome_.measurement = Measurement::kSearched;
    begin_claim_anew();
    state_.searched = true;
    confirm(fix);
  }
}

void Tracker::Step::confirm(const Fix& fix) {
  state_.claim.confirm(fix.probability);
  state_.accepted_time_us = input_.time_us;
  hold(on_grid(fix.modes.front().pose, map_.zone));
  if (settings_.recovers) motion_.try_drifts(filter_);
}

void Tracker::Step::hold(const GridPose& found) {
  if (settings_.start_is_known) state_.reach = Reach::around(found);
}

/// nullopt also if time ran out: a flight goes on without the search, or a map that takes longer would stop it. At the
/// start of a track that is an error instead: a smaller prior helps.
std::optional<Fix> Tracker::Step::search_within(const Prior& prior, const FeatureMap& seen, double time_share) {
  state_.last_search = state_.measured;
  std::optional<Fix> fix = search_.find(seen, prior,
                                        {.looks_beyond_prior = !begins_known(),
                                         .own_frame = features_,
                                         .search = {.scale_range = settings_.vehicle.scale_range}},
                                        time_share);
  if (!fix || fix->complete) return fix;
  // What an incomplete search has depends on the machine's speed, and tracks must be repeatable.
  if (is_first()) throw Interrupted("search-time-limit", fix->explanation);
  return std::nullopt;
}

}  // namespace roadfix
