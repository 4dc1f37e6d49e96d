// A flight as a sequence of steps: odometry and feature maps in, pose with covariance out (docs/method.md).
//
// A tracker holds what does not change during a flight. The state is a value: each step makes a new one from the old,
// so that a step that fails leaves the track as it was.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/filter/filter.hpp"
#include "core/locate/altitude.hpp"
#include "core/locate/map_view.hpp"
#include "core/track/last_view.hpp"
#include "core/track/reach.hpp"
#include "core/track/recent_frames.hpp"
#include "core/track/step_limits.hpp"
#include "core/track/track_claim.hpp"
#include "core/track/track_estimate.hpp"
#include "core/track/track_motion.hpp"
#include "core/track/track_settings.hpp"

namespace roadfix {

struct StepInput {
  std::int64_t sequence = 0;                     ///< >= 0, counts up by 1; numbers left out count as lost steps
  std::int64_t time_us = 0;                      ///< >= 0: when the frame was taken, microseconds since any epoch
  std::optional<Odometry> odometry;              ///< since the step before; turns within [-180, 180] degrees
  std::optional<OdometryCovariance> covariance;  ///< nullopt = it follows from VehicleNoise
  std::optional<FeatureMap> features;            ///< nullopt = nothing was seen
  /// That the features were found in: tells a camera or a link that has stopped. nullopt = they were found elsewhere.
  std::optional<SentPicture> picture = {};
  /// From where, if they show the ground in its relief; if the height above the sea is told, their size follows from
  /// that and the ground below the vehicle, and the map has heights.
  std::optional<Altitude> altitude = {};
};

/// Identifies a step; see StepInput.
struct StepStamp {
  std::int64_t sequence = 0;
  std::int64_t time_us = 0;
  friend bool operator==(const StepStamp&, const StepStamp&) = default;
};

struct TrackerState {
  FilterState filter;
  bool searched = false;          ///< the search at the start has been made
  std::optional<StepStamp> last;  ///< the step that led here; nullopt = none yet
  std::int64_t measured = 0;      ///< feature maps so far
  std::int64_t last_search = 0;   ///< `measured` at the last search
  double nadir_sigma_m = 0.0;     ///< of the last feature map
  TrackClaim claim;
  std::optional<std::int64_t> accepted_time_us;  ///< time of the last accepted measurement
  /// Frames that the next search lays around the frame of the step. Empty once the track has converged, so that frames
  /// from before a kidnapping are never combined with one after it.
  RecentFrames recent;
  LastView last_view;
  LearnedMotion motion;
  /// Of a track that began at a known place; nullopt = no other, or it has flown too far without being found.
  std::optional<Reach> reach;

  /// nullopt = no measurement was accepted yet.
  std::optional<double> since_accepted_s(std::int64_t now_us) const;
  friend bool operator==(const TrackerState&, const TrackerState&) = default;
};

struct StepResult {
  TrackerState state;
  TrackEstimate estimate;
};

class Tracker {
 public:
  /// Throws InvalidInput for a prior that does not meet the map and for a scale range that cannot be; LimitExceeded
  /// ("search-area-too-large").
  Tracker(MapView map, TrackSettings settings);

  /// Throws InvalidInput where number, time and movement of the step cannot follow: "step-late" for a sequence number
  /// not above the last, "time-backwards", "impossible-speed"; and as OdometryMotion does.
  static void require_possible(const TrackerState& before, const StepInput& step);
  /// Throws as require_possible(); InvalidInput of unusable feature maps; Interrupted when asked to stop, and at the
  /// deadline in the first step.
  StepResult advance(const TrackerState& before, const StepInput& step, const StepLimits& limits = {}) const;
  /// Height above ground of a vehicle at that height above the sea after the step that led to the state, or before the
  /// first one: that above the ground of the particles, or of what the prior allows. Throws as required_agl_m().
  double agl_m(const TrackerState& state, double above_sea_m) const;
  /// At most `count` poses: every k-th particle, without those of no weight.
  std::vector<GeoPose> particles(const TrackerState& state, std::size_t count) const;

  const MapView& map() const { return map_; }
  const TrackSettings& settings() const { return settings_; }

 private:
  class Step;
  MapView map_;
  TrackSettings settings_;
  PoseRegion start_;         ///< what the prior allows at the first step
  AcceptanceRegion region_;  ///< where particles may live in flight: the map and what lies around it
};

}  // namespace roadfix
