// What a track saw of late, to notice a camera or a video link that has stopped while the vehicle flies on, or that
// goes round in its last pictures. Two pictures of a live camera are never the same to the last cell; and where each
// picture of a stopped one has other noise (encoded anew, with a clock drawn in), roads stay where they were instead of
// moving as the odometry tells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/filter/motion.hpp"
#include "core/grid/feature_map.hpp"
#include "core/locate/recent_frames.hpp"

namespace roadfix {

/// Whether a vehicle that moved so far should see something else.
bool has_moved(double moved_m, double turned_rad);

/// Whether two pictures are one, to the last cell. Never of a feature map without any road: one wood is like the next.
bool is_same_view(const FeatureMap& a, const FeatureMap& b);

/// kRepeated: a picture that was seen before the vehicle moved, as is_same_view() tells. kStandsStill: other cells,
/// but its roads lie as they lay before the vehicle moved, and not as they should since: the camera has stopped, or the
/// odometry is wrong.
enum class View { kNew, kRepeated, kStandsStill };

/// A feature map with roads.
struct SeenView {
  std::uint64_t digest = 0;
  double moved_m = 0.0;     ///< along the odometry since it was seen for the first time
  double turned_rad = 0.0;  ///< in either direction

  friend bool operator==(const SeenView&, const SeenView&) = default;
};

struct LastView {
  static constexpr std::size_t kRemembered = 16;

  std::vector<SeenView> seen;  ///< different ones, the newest first
  bool stands_still = false;   ///< what was seen last is a View::kStandsStill
  RecentFrames earlier;        ///< one view at most, that later ones are compared with, in coarser cells

  /// The vehicle has moved on; a step that tells no odometry may have led anywhere. `tells_ground`: the odometry tells
  /// the motion over the ground (no wind, no lost steps), so that it says where roads should be seen next.
  void move(const std::optional<Odometry>& odometry, bool tells_ground);
  /// Compares it with earlier ones, and remembers it.
  View take_in(const FeatureMap& features);

  friend bool operator==(const LastView&, const LastView&) = default;

 private:
  bool lies_as_earlier(const FeatureMap& features);
};

}  // namespace roadfix
