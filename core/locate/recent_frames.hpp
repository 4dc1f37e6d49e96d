// What a track saw last, laid together along the odometry for a search: one frame of it may look like many places.
//
// As few frames as show new ground, as near as the odometry still holds them together, and none that would make more of
// them than a state may carry on disk.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/filter/motion.hpp"
#include "core/grid/combine.hpp"

namespace roadfix {

/// All in cells of one size.
class RecentFrames {
 public:
  static constexpr std::size_t kMaxFrames = 8;
  static constexpr int kMaxAcross = 512;                           ///< cells; a larger frame stands for itself
  static constexpr std::size_t kMaxCells = std::size_t{1} << 19U;  ///< of all frames, observed or not
  /// A frame closer to a kept one than this share of its shorter side shows nothing new.
  static constexpr double kApartShare = 0.25;
  /// 1 sigma by which the odometry may have lost a frame at its rim.
  static constexpr double kMaxSlipM = 20.0;
  static constexpr double kMaxSides = 1.5;  ///< of a frame, from it to the vehicle

  struct Frame {
    PlacedFeatures placed;  ///< from the vehicle now
    // Variances of that, per axis.
    double position_m2 = 0.0;
    double turn_rad2 = 0.0;

    friend bool operator==(const Frame&, const Frame&) = default;
  };

  RecentFrames() = default;
  /// Throws CorruptData "track-frames-corrupt" for what to_bytes() never writes.
  static RecentFrames of_bytes(std::span<const std::byte> bytes);
  std::vector<std::byte> to_bytes() const;

  /// The vehicle has moved on; lets go of the frames that are then too far off. `odometry` and `covariance` as
  /// OdometryMotion takes them.
  void move(const Odometry& odometry, const OdometryCovariance& covariance);
  /// `features` are of where the vehicle is now.
  void keep(const FeatureMap& features);
  /// `features` with the kept frames around them, its nadir theirs.
  FeatureMap laid_around(const FeatureMap& features) const;
  void clear() { frames_.clear(); }

  std::span<const Frame> frames() const { return frames_; }
  friend bool operator==(const RecentFrames&, const RecentFrames&) = default;

 private:
  std::vector<Frame> frames_;  ///< oldest first
};

}  // namespace roadfix
