// The last frames of a track, laid together along the odometry for a search, since a single frame may look like many
// places. Kept are frames that show new ground and that the odometry still places accurately, as many as a state on
// disk may hold.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/filter/motion.hpp"
#include "core/grid/combine.hpp"

namespace roadfix {

/// All frames have cells of one size.
class RecentFrames {
 public:
  static constexpr std::size_t kMaxFrames = 8;
  static constexpr int kMaxAcross = 512;                           ///< cells per side; a larger frame is not kept
  static constexpr std::size_t kMaxCells = std::size_t{1} << 19U;  ///< in all kept frames together, observed or not
  /// A frame closer to a kept one than this share of its shorter side shows nothing new.
  static constexpr double kApartShare = 0.25;
  /// A frame is kept until the error of the odometry at its rim reaches this, 1 sigma.
  static constexpr double kMaxSlipM = 20.0;
  /// A frame is kept until the vehicle is this many of its longer sides away.
  static constexpr double kMaxSides = 1.5;

  struct Frame {
    PlacedFeatures placed;     ///< where the frame was taken, seen from where the vehicle is now
    double position_m2 = 0.0;  ///< variance of that position, per axis
    double turn_rad2 = 0.0;    ///< variance of its heading

    friend bool operator==(const Frame&, const Frame&) = default;
  };

  RecentFrames() = default;
  /// As frames() gave them.
  explicit RecentFrames(std::vector<Frame> frames) : frames_(std::move(frames)) {}
  /// Whether the frame is small enough to be kept, and not too far away by now.
  static bool may_keep(const Frame& frame);

  /// The vehicle has moved; drops frames that are too far away now. `odometry` and `covariance`: as for OdometryMotion.
  void move(const Odometry& odometry, const OdometryCovariance& covariance);
  /// Keeps what is seen where the vehicle is now, if that is new ground and not too large.
  void keep(const FeatureMap& features);
  /// `features`, seen where the vehicle is now, with the kept frames laid around them. The nadir of the result is that
  /// of `features`.
  FeatureMap laid_around(const FeatureMap& features) const;
  void clear() { frames_.clear(); }

  std::span<const Frame> frames() const { return frames_; }
  friend bool operator==(const RecentFrames&, const RecentFrames&) = default;

 private:
  std::vector<Frame> frames_;  ///< oldest first
};

}  // namespace roadfix
