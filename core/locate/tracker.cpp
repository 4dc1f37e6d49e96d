#include "core/locate/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/locate/particle_matches.hpp"
#include "core/locate/prepare.hpp"
#include "core/locate/track_geometry.hpp"
#include "core/locate/track_motion.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr std::int64_t kSupportForConvergence = 3;
constexpr std::int64_t kMostSupport = 5;  // three rejections in a row take a claim back
const double kEvidenceForConvergence = std::log(100.0);
// So that a track that has long been right does not go on for long when it is not any more.
const double kMostEvidence = 2.0 * kEvidenceForConvergence;
constexpr std::int64_t kMeasurementsBetweenSearches = 10;
constexpr double kProbabilityForClaim = 0.95;         // of a search at the place that the measurements bear out
constexpr std::int64_t kMeasurementsBeforeClaim = 5;  // likewise, where a claim waits for a search
constexpr double kDoubtForSearch = 0.4;
constexpr double kRecoveryShare = 0.3;
constexpr double kMostOfAFix = 0.9;  // of the particles; the others begin anew
constexpr double kRecoveryRadiusM = 3000.0;
constexpr double kStaleAfterS = 60.0;

}  // namespace

const char* to_string(Measurement measurement) {
  switch (measurement) {
    case Measurement::kNone:
      return "none";
    case Measurement::kSkipped:
      return "skipped";
    case Measurement::kSearched:
      return "searched";
    case Measurement::kAccepted:
      return "accepted";
    case Measurement::kRejected:
      return "rejected";
    case Measurement::kUseless:
      break;
  }
  return "useless";
}

TrackSettings TrackSettings::paper(int particles) {
  TrackSettings settings;
  settings.start = TrackStart::kUniform;
  settings.recovers = false;
  settings.beyond_map_m = 0.0;
  settings.filter = FilterOptions::paper(particles);
  settings.evidence.kind = EvidenceKind::kEquation7;
  return settings;
}

Tracker::Tracker(MapView map, TrackSettings settings)
    : map_(std::move(map)),
      settings_(std::move(settings)),
      start_(acceptance_of(region_of(map_, settings_.prior))),
      region_(acceptance_of(region_of(map_, {}))) {
  region_.beyond_m = settings_.beyond_map_m;
}

/// One step on its way.
class Tracker::Step {
 public:
  Step(const Tracker& tracker, const TrackerState& before, const StepInput& input, const StepLimits& limits)
      : tracker_(tracker),
        settings_(tracker.settings_),
        input_(input),
        limits_(limits),
        state_(before),
        filter_(before.started ? Filter(settings_.filter, tracker.region_, std::move(state_.filter), limits.threads)
                               : Filter(settings_.filter, tracker.region_, settings_.seed, limits.threads)) {}

  StepResult run() {
    require_in_order();
    if (input_.features) features_ = in_cells_of(tracker_.map_, *input_.features);
    if (state_.started) {
      estimate_.missed_steps = input_.sequence - state_.sequence - 1;
      move();
    } else {
      filter_.start_uniformly(tracker_.start_);
      state_.started = true;
    }
    if (features_) {
      measure();
      if (may_search()) state_.recent.keep(*features_);
    }
    state_.sequence = input_.sequence;
    state_.time_us = input_.time_us;
    describe();
    if (estimate_.converged) state_.recent.clear();
    state_.filter = filter_.state();
    return {std::move(state_), std::move(estimate_)};
  }

 private:
  void require_in_order() const {
    if (!state_.started) return;
    if (input_.sequence <= state_.sequence) {
      throw InvalidInput("step-late", fmt::format("step {} comes after step {}: steps count up; leave late ones out",
                                                  input_.sequence, state_.sequence));
    }
    if (input_.time_us <= state_.time_us) {
      throw InvalidInput("time-backwards",
                         fmt::format("the capture time {} us is not after {} us of the step before: set the clock, or "
                                     "begin a new track",
                                     input_.time_us, state_.time_us));
    }
  }

  double seconds() const { return 1e-6 * static_cast<double>(input_.time_us - state_.time_us); }

  void move() {
    if (seconds() > static_cast<double>(settings_.longest_gap.count())) {
      filter_.start_uniformly(tracker_.region_);
      forget_support();
      state_.recent.clear();
      return;
    }
    if (!moved()) forget_support();
  }

  bool may_search() const { return settings_.recovers || settings_.start == TrackStart::kSearch; }

  /// Only where the odometry tells how the ground below goes on.
  void carry_on(const Odometry& odometry, const OdometryCovariance& covariance) {
    if (settings_.vehicle.wind_walk > 0.0 || estimate_.missed_steps > 0) {
      state_.recent.clear();
    } else {
      state_.recent.move(odometry, covariance);
    }
  }

  /// False where the belief left the region and began anew.
  bool moved() {
    const VehicleNoise& vehicle = settings_.vehicle;
    if (input_.odometry) {
      const OdometryCovariance told = input_.covariance ? *input_.covariance : covariance_of(*input_.odometry, vehicle);
      const OdometryMotion as_told(*input_.odometry, told, seconds(), vehicle.wind_walk);
      carry_on(*input_.odometry, told);
      if (estimate_.missed_steps == 0) return filter_.predict(as_told);
      const auto [odometry, covariance] =
          with_lost_steps(*input_.odometry, told, static_cast<double>(estimate_.missed_steps));
      return filter_.predict(OdometryMotion(odometry, covariance, seconds(), vehicle.wind_walk));
    }
    state_.recent.clear();
    if (vehicle.planar) {
      return filter_.predict(
          PlanarMotion{vehicle.planar->speed_m_s, vehicle.planar->turn_rate_rad_s, seconds(), vehicle.wind_walk});
    }
    return filter_.predict(ConstantVelocityMotion{seconds()});
  }

  void forget_support() {
    state_.supported = 0;
    state_.evidence = 0.0;
    state_.searched = false;
    state_.compared = false;
  }

  void measure() {
    ++state_.measured;
    if (settings_.measure_every > 1 && state_.measured % settings_.measure_every != 1) {
      estimate_.measurement = Measurement::kSkipped;
      return;
    }
    if (settings_.start == TrackStart::kSearch && !state_.searched && start_by_search()) return;
    const std::vector<MatchSums> sums =
        match_particles(tracker_.map_, *features_, filter_.particles(), limits_.threads, limits_.stop);
    const auto frame_cells = static_cast<std::int64_t>(features_->cells.observed_count());
    if (unseen_by_map(sums, frame_cells)) {
      estimate_.measurement = Measurement::kUseless;
    } else {
      weigh(sums, frame_cells);
    }
    const std::int64_t wait =
        has_evidence() && !state_.compared ? kMeasurementsBeforeClaim : kMeasurementsBetweenSearches;
    if (settings_.recovers && wants_search() && state_.measured - state_.last_search >= wait) recover();
  }

  void weigh(const std::vector<MatchSums>& sums, std::int64_t frame_cells) {
    std::vector<double> log_likelihoods(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
      log_likelihoods[i] = settings_.evidence.log_likelihood(sums[i], frame_cells, features_->cell_m);
    }
    const Correction correction = filter_.correct(log_likelihoods);
    estimate_.mean_likelihood = correction.mean_likelihood;
    const bool accepted = correction.usable && settings_.evidence.supports(correction.mean_likelihood);
    estimate_.measurement = !correction.usable ? Measurement::kUseless
                            : accepted         ? Measurement::kAccepted
                                               : Measurement::kRejected;
    if (accepted) accept();
    if (estimate_.measurement == Measurement::kRejected) reject();
    if (correction.usable) weigh_belief(std::log(correction.mean_likelihood));
  }

  /// Particles gather somewhere also where nothing speaks for it. A sum that begins anew at 0 (Page's test) says
  /// whether something does, and forgets what came before a kidnapping.
  void weigh_belief(double log_odds) {
    state_.evidence = std::clamp(state_.evidence + log_odds, 0.0, kMostEvidence);
    if (state_.evidence == 0.0) state_.compared = false;
  }

  /// Nothing has spoken for the belief for long, be it that nothing could.
  bool stale() const { return since_accepted_s().value_or(0.0) >= kStaleAfterS; }

  std::optional<double> since_accepted_s() const {
    if (!state_.accepted_time_us) return std::nullopt;
    return 1e-6 * static_cast<double>(input_.time_us - *state_.accepted_time_us);
  }

  /// Whether the belief lies where the map shows next to nothing, so that a frame speaks neither for nor against it.
  bool unseen_by_map(const std::vector<MatchSums>& sums, std::int64_t frame_cells) const {
    constexpr double kLeastShare = 0.25;
    if (settings_.evidence.kind == EvidenceKind::kEquation7) return false;
    const Particles& p = filter_.particles();
    double seen = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) seen += p.weight[i] * static_cast<double>(sums[i].n);
    return seen < kLeastShare * static_cast<double>(frame_cells);
  }

  void accept() {
    state_.supported = std::min(state_.supported + 1, kMostSupport);
    state_.accepted_time_us = input_.time_us;
  }

  /// A claim that is taken back waits for a search.
  void reject() {
    state_.supported = std::max<std::int64_t>(0, std::min(state_.supported, kMostSupport) - 1);
    if (state_.supported < kSupportForConvergence) state_.compared = false;
  }

  /// nullopt where the area is beyond the limit, or the time was over first: a flight goes on without a search, as it
  /// would be stuck with a map that takes longer. At its beginning that is an error, as a smaller prior helps.
  std::optional<Fix> searched(const Prior& prior) {
    FixOptions options;
    options.max_search_km2 = settings_.max_search_km2;
    options.threads = 1;  // threads of a search add up in any order, and a track must come out the same
    options.time_limit = limits_.search_time;
    options.stop = limits_.stop;
    options.calibration = settings_.calibration;
    state_.last_search = state_.measured;
    try {
      Fix fix = locate(tracker_.map_, state_.recent.laid_around(*features_), prior, options);
      if (fix.complete) return fix;
      // What it has depends on the machine, and a track must come out the same.
      if (state_.sequence < 0) throw Interrupted("search-time-limit", fix.explanation);
      return std::nullopt;
    } catch (const LimitExceeded&) {
      return std::nullopt;
    }
  }

  /// A circle around all that the belief holds for possible; nullopt where that is beyond the map.
  std::optional<Prior> belief() const {
    const Particles& p = filter_.particles();
    GridBox box{{p.east_m[0], p.north_m[0]}, {p.east_m[0], p.north_m[0]}};
    for (std::size_t i = 0; i < p.size(); ++i) {
      box.min = {std::min(box.min.east_m, p.east_m[i]), std::min(box.min.north_m, p.north_m[i])};
      box.max = {std::max(box.max.east_m, p.east_m[i]), std::max(box.max.north_m, p.north_m[i])};
    }
    const GridPoint centre{0.5 * (box.min.east_m + box.max.east_m), 0.5 * (box.min.north_m + box.max.north_m)};
    const double radius_m = distance_m(box.min, box.max) / 2.0;
    if (distance_m(nearest(tracker_.map_.extent, centre), centre) > radius_m) return std::nullopt;
    Prior prior;
    prior.circle = GeoCircle{tracker_.map_.zone.unproject(centre), radius_m + 1.0};
    return prior;
  }

  /// The prior as it was given holds for the first step only.
  bool start_by_search() {
    const bool first = state_.sequence < 0;
    const std::optional<Prior> prior = first ? settings_.prior : belief();
    if (!prior) return false;
    state_.searched = true;
    const std::optional<Fix> fix = searched(*prior);
    if (!fix || fix->modes.empty()) return false;
    double known = 0.0;
    for (const FixMode& mode : fix->modes) known += mode.weight;
    filter_.restart_from(proposals_of(tracker_.map_, *fix), std::clamp(1.0 - known, 1.0 - kMostOfAFix, 0.9),
                         first ? tracker_.start_ : tracker_.region_);
    estimate_.measurement = Measurement::kSearched;
    if (fix->status == FixStatus::kFix) believe(*fix);
    return true;
  }

  void believe(const Fix& fix) {
    accept();
    weigh_belief(std::log(fix.probability / (1.0 - fix.probability)));
    state_.compared = true;
  }

  void recover() {
    const GridPose believed = clusters_of(filter_.particles(), settings_.clusters).front().mean;
    std::optional<Fix> fix = searched({});
    if (!fix) {
      Prior near;
      near.circle = GeoCircle{tracker_.map_.zone.unproject(believed.position), kRecoveryRadiusM};
      fix = searched(near);
    }
    if (!fix || fix->modes.empty()) return;
    const bool agrees = is_same_place(on_grid(fix->modes.front().pose, tracker_.map_.zone), believed);
    if (agrees && fix->probability >= kProbabilityForClaim) {
      state_.compared = true;
    } else if (fix->status != FixStatus::kFix) {
      filter_.inject(proposals_of(tracker_.map_, *fix), kRecoveryShare);
    } else {
      filter_.start_from(proposals_of(tracker_.map_, *fix), 1.0 - kMostOfAFix, tracker_.region_);
      estimate_.measurement = Measurement::kSearched;
      forget_support();
      state_.searched = true;
      believe(*fix);
    }
  }

  void describe() {
    estimate_.sequence = state_.sequence;
    estimate_.time_us = state_.time_us;
    const auto clusters = clusters_of(filter_.particles(), settings_.clusters);
    estimate_.cluster_count = clusters.size();
    for (std::size_t i = 0; i < std::min(clusters.size(), TrackEstimate::kMostClusters); ++i) {
      estimate_.clusters.push_back(to_geographic(tracker_.map_, clusters[i]));
    }
    estimate_.particles = filter_.particles().size();
    estimate_.resets = filter_.state().resets;
    estimate_.doubt = filter_.doubt();
    estimate_.since_accepted_s = since_accepted_s();
    estimate_.converged = clusters.front().weight >= settings_.converged_weight &&
                          clusters.front().sigma_m() <= settings_.converged_sigma_m &&
                          state_.supported >= kSupportForConvergence && is_borne_out() &&
                          estimate_.doubt <= kDoubtForSearch &&
                          estimate_.since_accepted_s.value_or(kStaleAfterS) < kStaleAfterS;
  }

  bool wants_search() const {
    if (filter_.doubt() > kDoubtForSearch || stale()) return true;
    if (has_evidence()) return !state_.compared;
    return state_.evidence == 0.0 && estimate_.measurement != Measurement::kUseless;
  }

  bool has_evidence() const { return state_.evidence >= kEvidenceForConvergence; }

  /// Equation (7) is no ratio to chance, and bears out what it does not reject.
  bool is_borne_out() const {
    if (settings_.evidence.kind == EvidenceKind::kEquation7) return true;
    return has_evidence() && (state_.compared || !settings_.recovers);
  }

  const Tracker& tracker_;
  const TrackSettings& settings_;
  const StepInput& input_;
  const StepLimits& limits_;
  TrackerState state_;
  Filter filter_;
  std::optional<FeatureMap> features_;
  TrackEstimate estimate_;
};

StepResult Tracker::advance(const TrackerState& before, const StepInput& step, const StepLimits& limits) const {
  return Step(*this, before, step, limits).run();
}

std::vector<GeoPose> Tracker::particles(const TrackerState& state, std::size_t count) const {
  const Particles& p = state.filter.particles;
  std::vector<GeoPose> poses;
  const std::size_t stride = std::max<std::size_t>(1, (p.size() + count - 1) / std::max<std::size_t>(1, count));
  for (std::size_t i = 0; i < p.size(); i += stride) {
    poses.push_back(on_earth(p.at(i).pose(), map_.zone));
  }
  return poses;
}

}  // namespace roadfix
