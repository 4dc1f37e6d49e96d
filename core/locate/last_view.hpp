// What a track saw last, to notice a camera or a video link that has stopped: it shows one picture again and again
// while the vehicle flies on. Two pictures of a live camera are never the same to the last cell.
#pragma once

#include <cstdint>
#include <optional>

#include "core/filter/motion.hpp"
#include "core/grid/feature_map.hpp"

namespace roadfix {

/// Whether a vehicle that moved so far should see something else.
bool has_moved(double moved_m, double turned_rad);

/// Whether two pictures are one, to the last cell. Never of a feature map without any road: one wood is like the next.
bool is_same_view(const FeatureMap& a, const FeatureMap& b);

struct LastView {
  std::uint64_t digest = 0;  ///< of the feature map that was seen last; 0 = none
  double moved_m = 0.0;      ///< along the odometry since it was seen for the first time
  double turned_rad = 0.0;   ///< in either direction

  /// The vehicle has moved on; a step that tells no odometry may have led anywhere.
  void move(const std::optional<Odometry>& odometry);
  /// True where `features` are those that were seen before the vehicle moved, as is_same_view() tells.
  bool sees_again(const FeatureMap& features);

  friend bool operator==(const LastView&, const LastView&) = default;
};

}  // namespace roadfix
