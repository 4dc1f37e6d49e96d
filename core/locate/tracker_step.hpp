// One step of a track on its way: the belief is moved, weighted by what was seen, and searched for where that is due.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/locate/fix.hpp"
#include "core/locate/particle_matches.hpp"
#include "core/locate/tracker.hpp"

namespace roadfix {

class Tracker::Step {
  static constexpr double kMaxDoubt = 0.4;  // beyond it a place is not claimed, and is searched for

 public:
  /// Refers to all but `before`.
  Step(const Tracker& tracker, const TrackerState& before, const StepInput& input, const StepLimits& limits);

  /// Once. Throws as Tracker::advance does.
  StepResult run();

 private:
  void require_in_order() const;
  double seconds() const;
  std::optional<double> since_accepted_s() const;
  void see();
  void measure();
  void weigh(const ParticleMatches& matches, std::int64_t frame_cells);
  bool is_unseen_by_map(std::span<const MatchSums> sums, std::int64_t frame_cells) const;
  void forget_support();
  void fill_estimate();
  bool has_converged(const Cluster& best) const;
  bool is_borne_out() const;

  // tracker_motion.cpp
  void move();
  bool predict_motion();
  bool follow_odometry(bool coasted);
  bool coast(bool begins);
  template <MotionModel Motion>
  bool predict(const Motion& motion);
  bool coasts() const;
  void carry_frames_on(const Odometry& odometry, const OdometryCovariance& covariance);
  void doubt_odometry();
  Wind wind() const;
  double speed_m_s() const;
  AcceptanceRegion region() const;

  // tracker_search.cpp; `seen` is the last feature map, with the frames before it laid around
  bool may_search() const;
  bool start_by_search();
  void search_if_due();
  bool wants_search() const;
  void recover();
  bool holds_at_other_scales(const Fix& fix, const Prior& prior, const FeatureMap& seen);
  void confirm(const Fix& fix);
  std::optional<Fix> search_within(const Prior& prior, const FeatureMap& seen);
  std::optional<Fix> search_for(const FeatureMap& features, const Prior& prior, FixOptions options);

  // tracker_look.cpp
  void look_around_if_due();
  bool is_look_older_than(std::int64_t us, double flown_m) const;
  double flown_since_look_m() const;
  void look_around();
  void move_beside(const Fix& fix, const FeatureMap& seen, double log_scale);

  const Tracker& tracker_;
  const TrackSettings& settings_;
  const StepInput& input_;
  const StepLimits& limits_;
  TrackerState state_;
  Filter filter_;
  std::optional<FeatureMap> features_;
  TrackEstimate estimate_;
};

}  // namespace roadfix
