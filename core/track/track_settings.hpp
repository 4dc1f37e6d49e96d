// What a track is told before its first step: where to begin, what the vehicle is like, how sure to be.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/filter/filter.hpp"
#include "core/locate/calibration.hpp"
#include "core/locate/prior.hpp"
#include "core/track/measurement_model.hpp"

namespace roadfix {

/// The motion of the air over the ground, where odometry or the planar speed is relative to the air.
struct Wind {
  double sigma_m_s = 0.0;  ///< 1 sigma of the first wind, per axis

  /// Growth of that sigma, m/s per square root of a second: a wind changes by its own size in 40 minutes. A filter that
  /// took it for constant, or for zero at first, would become sure of a wrong one.
  double walk() const { return sigma_m_s / 50.0; }
  bool is_none() const { return sigma_m_s == 0.0; }
};

/// What is assumed of a step that does not tell it.
struct VehicleNoise {
  /// If given, steps without odometry follow equation (4) with these; else the vehicle keeps its velocity, which may
  /// change by half of itself within a second.
  struct Planar {
    Gaussian speed_m_s;
    Gaussian turn_rate_rad_s;
  };
  std::optional<Planar> planar;
  /// Odometry without covariance: 1 sigma is this share of the distance or turn, and a little (covariance_of()).
  double odometry_share = 0.05;
  Wind wind;
  /// The ground in the feature maps may be smaller by this share, or larger by as much, by an error of the altitude
  /// that stays much the same from step to step; in [0, kMaxScaleRange].
  double scale_range = 0.0;
  /// Replaces FeatureMap::nadir_sigma_m of all feature maps. Part of the stated accuracy of the position, and not
  /// averaged over frames, since a camera that is mounted askew errs alike in all of them.
  std::optional<double> nadir_sigma_m;
};

enum class TrackStart { kSearch, kUniform };

struct TrackSettings {
  Prior prior;  ///< where the vehicle may be at the first step
  /// The prior is no guess: the vehicle is within its circle, of at most Reach::kMaxM, at the first step, as where it
  /// had GPS until then. Places to which the odometry cannot have led it from there need not be told from its own.
  bool start_is_known = false;
  TrackStart start = TrackStart::kSearch;
  /// Spreads the particles and searches again when measurements contradict the belief, and searches before the first
  /// claim if no search has ruled out other places (see TrackClaim). Without it a track converges by its particles
  /// alone.
  bool recovers = true;
  FilterOptions filter;
  MeasurementModel measurement_model;
  VehicleNoise vehicle;
  std::uint64_t seed = 1;
  /// How far beyond the map's rim a vehicle is still followed: held back at the rim, a confident belief would be pushed
  /// along it, away from a vehicle that flies a curve outside. No particles are drawn there. Small enough for the
  /// circle searched around a belief (TrackSearch::kAroundM) to meet the map.
  double beyond_map_m = 1000.0;
  /// Limit of the prior of TrackStart::kSearch, and of all later searches: over larger maps, recovery searches around
  /// the last place.
  std::optional<double> max_search_km2 = 2000.0;
  std::shared_ptr<const Calibration> calibration = shipped_calibration();  ///< of its searches; never nullptr

  /// The paper's filter: uniform start, no search, equation (7), no particle beyond the map.
  static TrackSettings paper(int particles);
};

}  // namespace roadfix
