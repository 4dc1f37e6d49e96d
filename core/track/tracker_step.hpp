// One step of a track: the belief is moved, weighted by what was seen, and searched for where that is due.
//
// Only the step changes a track. It uses parts that know nothing of the track's state: StepMotion moves the particles,
// log_likelihoods_of() weights them, TrackSearch and look_around() find places.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/track/particle_matches.hpp"
#include "core/track/step_estimate.hpp"
#include "core/track/track_look.hpp"
#include "core/track/track_motion.hpp"
#include "core/track/track_search.hpp"
#include "core/track/tracker.hpp"

namespace roadfix {

class Tracker::Step {
 public:
  /// `input` is possible after `before` (require_possible()). All but `before` must outlive this.
  Step(const Tracker& tracker, const TrackerState& before, const StepInput& input, const StepLimits& limits);

  /// Once. Throws as Tracker::advance does.
  StepResult run();

 private:
  bool is_first() const { return !state_.last; }
  bool begins_known() const { return is_first() && settings_.start_is_known; }
  FeatureMap seen_from_above_ground(const Altitude& told);
  void take_in_features();
  void begin_or_move();
  void move();
  void see();
  ParticleMatches matches(const MapView& map, const FeatureMap& features) const;
  bool is_over_bare_ground() const;
  std::optional<std::vector<double>> log_likelihoods() const;
  void measure();
  void weigh(std::span<const double> log_likelihoods);
  bool saw_nothing() const;
  void begin_claim_anew();

  // tracker_searches.cpp; `seen` is the last feature map, with the frames before it laid around
  bool may_search() const;
  bool start_by_search();
  void look_around_if_due();
  LookArea look_area(const GridPose& believed) const;
  void take(const Look& look, LookAge last);
  void search_if_due();
  bool wants_search() const;
  void recover();
  void rely_on_reach(const Fix& anywhere, const FeatureMap& seen, const GridPose& believed);
  bool is_at(const GridPose& believed, const FixMode& mode) const;
  bool confirms(const Fix& fix, const GridPose& believed) const;
  void settle(const Fix& fix, bool holds, const Prior& prior, const GridPose& believed);
  void confirm(const Fix& fix);
  void hold(const GridPose& found);
  std::optional<Fix> search_within(const Prior& prior, const FeatureMap& seen, double time_share);

  const Tracker& tracker_;
  const MapView& map_;
  const TrackSettings& settings_;
  const StepInput& input_;
  const StepLimits& limits_;
  TrackSearch search_;
  std::optional<FeatureMap> features_;  ///< of the input, in cells of the map, in the size that the ground below has
  // The filter and the motion of the state are in `filter_` and `motion_` until the step ends.
  TrackerState state_;
  StepMotion motion_;
  Filter filter_;
  StepOutcome outcome_;
};

}  // namespace roadfix
