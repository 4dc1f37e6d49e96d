// A flight as a sequence of steps: odometry and feature maps in, pose with covariance out (docs/method.md).
//
// A tracker holds what does not change. The state is a value: a step makes a new one from the old, so that a step that
// fails leaves the track as it was.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/filter/clusters.hpp"
#include "core/filter/filter.hpp"
#include "core/locate/fix.hpp"
#include "core/locate/last_view.hpp"
#include "core/locate/map_view.hpp"
#include "core/locate/measurement_model.hpp"
#include "core/locate/recent_frames.hpp"
#include "core/locate/track_claim.hpp"

namespace roadfix {

/// The motion of the air over the ground, where odometry or the planar speed is relative to the air.
struct Wind {
  double sigma_m_s = 0.0;  ///< 1 sigma of the first wind, per axis
  double walk = 0.0;       ///< growth of that sigma, m/s per square root of a second

  /// One that is not given follows from the other: a wind changes by its own size in 40 minutes. A filter that takes it
  /// for constant, or for nothing at first, comes to be sure of a wrong one.
  static Wind of(std::optional<double> sigma_m_s, std::optional<double> walk);
  bool is_none() const { return sigma_m_s == 0.0 && walk == 0.0; }
};

/// Takes the place of what a step does not tell.
struct VehicleNoise {
  /// Where given, steps without odometry follow equation (4) with these; else the velocity goes on as it was, and may
  /// change by half of itself within a second.
  struct Planar {
    Gaussian speed_m_s;
    Gaussian turn_rate_rad_s;
  };
  std::optional<Planar> planar;
  // Odometry without covariance: 1 sigma is the share of the distance or turn, and at least ...
  double odometry_share = 0.05;
  double odometry_m = 0.3;  ///< ... so much per axis
  Angle odometry_turn = Angle::degrees(0.5);
  Wind wind;
  /// The ground in the feature maps may be smaller by this share, or larger by as much, by an error of the altitude
  /// that stays much the same from step to step; in [0, kMaxScaleRange].
  double scale_range = 0.0;
  /// Of all feature maps, in place of what they say (FeatureMap::nadir_sigma_m). Part of the standard deviations of the
  /// position, since a camera that is mounted askew errs alike in all frames.
  std::optional<double> nadir_sigma_m;
};

enum class TrackStart { kSearch, kUniform };

struct TrackSettings {
  Prior prior;  ///< where the vehicle may be at the first step
  TrackStart start = TrackStart::kSearch;
  /// Spreads and searches anew when the measurements speak against the belief, and searches before the first claim
  /// where no search has told it from other places (see TrackClaim). Without it a track converges by its particles
  /// alone.
  bool recovers = true;
  FilterOptions filter;
  MeasurementModel measurement_model;
  VehicleNoise vehicle;
  ClusterOptions clusters;
  std::uint64_t seed = 1;
  int measure_every = 1;  ///< weight by every k-th feature map only
  double converged_weight = 0.9;
  double converged_sigma_m = 25.0;
  /// So far beyond the rim of the map a vehicle is still followed: held back at the rim, a belief that is sure of
  /// itself would be pushed along it, away from a vehicle that flies a curve outside. No particle is drawn there.
  double beyond_map_m = 1000.0;
  /// Of the prior where the start is searched for. Where a uniform start was more, recovery looks around the last
  /// place.
  std::optional<double> max_search_km2 = 2000.0;
  std::chrono::seconds longest_gap{600};           ///< after it the belief is thrown away
  std::shared_ptr<const Calibration> calibration;  ///< used by its searches; nullptr = the one that is shipped

  /// The paper's filter: uniform start, no search, equation (7), no particle beyond the map.
  static TrackSettings paper(int particles);
};

/// So long a place is claimed without an accepted measurement; then it is searched for.
inline constexpr double kStaleAfterS = 60.0;

struct StepInput {
  std::int64_t sequence = 0;                     ///< counts up by 1; numbers left out count as lost steps
  std::int64_t time_us = 0;                      ///< when the frame was taken, microseconds since any epoch
  std::optional<Odometry> odometry;              ///< since the step before
  std::optional<OdometryCovariance> covariance;  ///< nullopt = it follows from VehicleNoise
  std::optional<FeatureMap> features;            ///< nullopt = nothing was seen
};

struct TrackerState {
  FilterState filter;
  bool started = false;
  bool searched = false;  ///< the search of the start has been tried
  std::int64_t sequence = -1;
  std::int64_t time_us = 0;
  std::int64_t measured = 0;     ///< feature maps so far
  std::int64_t last_search = 0;  ///< `measured` at the last search
  double nadir_sigma_m = 0.0;    ///< of the last feature map
  TrackClaim claim;
  std::optional<std::int64_t> accepted_time_us;  ///< time of the last accepted measurement
  /// What its next search lays together with the frame of the step. Empty once it has converged, so that what was seen
  /// before a kidnapping is not laid with what is seen after it.
  RecentFrames recent;
  /// Time of the last search around the place that bore it out; nullopt = none since a search found the place, a
  /// measurement spoke against it or such a search did not bear it out, and nothing is claimed then.
  std::optional<std::int64_t> looked_time_us;
  bool drifts = false;  ///< such a search found the vehicle beside it: a wind is learned though none was told
  LastView last_view;
  std::optional<BodyVelocity> velocity;  ///< that the last odometry told
  bool coasts = false;  ///< the last step told no motion: the drift of the particles is all of their velocity
  friend bool operator==(const TrackerState&, const TrackerState&) = default;
};

struct TrackCluster {
  GeoPose pose;
  double weight = 0.0;              ///< share of all particles' weight, 0 to 1
  std::array<double, 2> sigma_m{};  ///< 1 sigma along the major and minor axis
  Angle ellipse_heading;            ///< direction of the major axis, clockwise from true north, in [0, 180) degrees
  Angle heading_sigma;              ///< 1 sigma
  double radius95_m = 0.0;          ///< holds the vehicle with 95 %, if it is in the cluster at all
  double scale = 1.0;        ///< how many times larger the ground is than the feature maps say, within the scale range
  double scale_sigma = 0.0;  ///< 1 sigma
};

/// What became of a step's feature map; kRepeated = nothing, since the camera or its link has stopped (LastView).
enum class Measurement { kNone, kSkipped, kSearched, kAccepted, kRejected, kUseless, kRepeated };
/// "none", "skipped" ...: the word for it in answers and files.
const char* to_string(Measurement measurement);

struct TrackEstimate {
  std::int64_t sequence = 0;
  std::int64_t time_us = 0;
  bool converged = false;              ///< only then the first cluster is a position to fly on
  std::vector<TrackCluster> clusters;  ///< heaviest first, at most kMaxClusters of them
  std::size_t cluster_count = 0;       ///< of all, also those that are not among `clusters`
  std::size_t particles = 0;           ///< number of them
  std::uint64_t resets = 0;            ///< times that the belief was thrown away
  Measurement measurement = Measurement::kNone;
  /// How many times likelier the measurement was under the belief before it than by chance, on average.
  double mean_likelihood = 0.0;
  double doubt = 0.0;                      ///< how much worse late measurements fit than earlier ones, 0 to 1
  std::optional<double> since_accepted_s;  ///< nullopt = no measurement was accepted yet
  bool drifts = false;                     ///< the odometry was found wrong, and a drift of it is learned
  std::int64_t missed_steps = 0;           ///< sequence numbers left out before this step
  static constexpr std::size_t kMaxClusters = 8;
};

struct StepResult {
  TrackerState state;
  TrackEstimate estimate;
};

struct StepLimits {
  int threads = 1;
  std::optional<std::chrono::steady_clock::time_point> searches_end{};  ///< at it a search ends as it is
  std::stop_token stop;
};

class Tracker {
 public:
  /// Throws InvalidInput for a prior that does not meet the map and for a scale range that cannot be; LimitExceeded
  /// ("search-area-too-large").
  Tracker(MapView map, TrackSettings settings);

  /// Throws InvalidInput: "step-late" for a sequence number not above the last, "time-backwards", those of
  /// OdometryMotion and of unusable feature maps; Interrupted by `stop`, and by `searches_end` at the first step.
  StepResult advance(const TrackerState& before, const StepInput& step, const StepLimits& limits = {}) const;
  /// Thinned to at most `count` poses, every k-th particle.
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
