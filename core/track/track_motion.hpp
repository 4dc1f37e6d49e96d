// How the vehicle of a track moves in a step: by its odometry, by equation (4), or on with its last velocity. Knows
// neither the map nor what frames show.
#pragma once

#include <cstdint>
#include <optional>

#include "core/filter/filter.hpp"
#include "core/track/reach.hpp"
#include "core/track/track_settings.hpp"

namespace roadfix {

/// What a step tells of the motion since the one before.
struct ToldMotion {
  std::optional<Odometry> odometry;
  std::optional<OdometryCovariance> covariance;  ///< nullopt = it follows from VehicleNoise
  double seconds = 0.0;
  std::int64_t lost_steps = 0;  ///< between the two; their motion is unknown
};

/// What a track keeps of the motion from step to step.
struct LearnedMotion {
  std::optional<BodyVelocity> velocity;  ///< that the last odometry told, seen from the pose at its end
  double turn_rate_rad_s = 0.0;          ///< likewise, clockwise
  bool odometry_is_wrong = false;        ///< was found to be: a wind is learned though none was told
  bool coasts = false;     ///< the last step told no motion: the drift of the particles is their whole velocity
  double coasted_s = 0.0;  ///< since the last step that told the motion
  double unseen_m = 0.0;   ///< travelled since a frame last told something of the place
  double unseen_s = 0.0;   ///< flown since then by the speed that is told for the vehicle
  friend bool operator==(const LearnedMotion&, const LearnedMotion&) = default;
};

class StepMotion {
 public:
  /// `flight`: where particles live, but for their drift. `vehicle` and `flight` outlive this.
  StepMotion(const VehicleNoise& vehicle, const AcceptanceRegion& flight, const ToldMotion& told,
             const LearnedMotion& before);

  /// Without odometry that, unseen, repeats that of the step before to the last digit: the vehicle's estimator has
  /// stopped, as those of live ones differ by their noise.
  const ToldMotion& told() const { return told_; }
  const LearnedMotion& learned() const { return learned_; }
  /// Of this step's odometry, which must be there, by itself, without that of lost steps.
  OdometryCovariance odometry_covariance() const;
  /// Whether odometry, if there is any, is the whole motion over the ground: no wind, no lost steps.
  bool odometry_is_complete() const;
  /// By the last odometry; before there was any, the planar speed if that is given, else 0.
  double speed_m_s() const;
  /// Distance of this step and the lost ones, by odometry or speed_m_s().
  double travelled_m() const;
  /// Where particles live, and the drift of new ones.
  AcceptanceRegion region() const;

  /// Moves what bounds the vehicle's place.
  void carry(Reach& reach) const;
  /// Moves the particles; returns what Filter::predict() does. Throws as OdometryMotion does.
  double move(Filter& filter);
  /// A frame told something of the place.
  void see() { learned_.unseen_m = learned_.unseen_s = 0.0; }
  /// Forgets what was learned, but for odometry found to be wrong.
  void begin_anew();

  /// Gives some particles another velocity, unless drift is learned anyway (wind, no odometry). If the odometry is
  /// worse than it says, frames will favour those before the belief is left behind.
  void try_drifts(Filter& filter) const;
  /// The odometry, if there is any, was found to be wrong: from now on its drift is learned.
  void learn_drift(Filter& filter);

 private:
  bool coasts() const { return !told_.odometry && !vehicle_.planar; }
  /// How far at most without odometry. Infinite where nobody knows how fast it is.
  double strays_by_m() const;
  Wind wind() const;
  void learn_velocity(const Odometry& odometry);
  OdometryCovariance covariance_after(double unseen_m) const;
  double follow_odometry(Filter& filter, bool coasted);
  double follow_speed(Filter& filter, const VehicleNoise::Planar& planar);
  double coast(Filter& filter, bool begins);
  Gaussian turn_goes_on() const;
  template <MotionModel Motion>
  double predict(Filter& filter, const Motion& motion) const;

  const VehicleNoise& vehicle_;
  const AcceptanceRegion& flight_;
  ToldMotion told_;
  LearnedMotion learned_;
};

}  // namespace roadfix
