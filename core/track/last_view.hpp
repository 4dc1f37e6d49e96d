// What a track saw lately, to notice a camera or video link that has stopped while the vehicle flies on, or that
// repeats its last pictures. Two pictures of a live camera are never the same to the last cell. If those of a stopped
// one differ by noise (encoded anew, with a clock drawn in), what they show stays in place instead of moving as the
// odometry says: the pictures as they were sent, or, where those are not known, their roads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/filter/motion.hpp"
#include "core/grid/feature_map.hpp"
#include "core/grid/picture_sketch.hpp"
#include "core/track/recent_frames.hpp"
#include "core/units/planar.hpp"

namespace roadfix {

/// kRepeated: the same picture was seen before the vehicle moved, by its cells (is_same_view()) or by itself.
/// kStandsStill: other bytes and cells, but the picture or its roads lie where they lay before the vehicle moved: the
/// camera has stopped, or the odometry is wrong.
/// kMayStandStill: so does the picture, for the first time: the vehicle may have leaned by as much as it moved.
enum class View { kNew, kRepeated, kMayStandStill, kStandsStill };

/// A camera's picture as it was sent, whatever height and attitude it is measured by.
struct SentPicture {
  std::uint64_t digest = 0;  ///< equal for equal bytes
  PictureSketch sketch{};
};

/// A feature map with roads, or the picture that they were found in.
struct SeenView {
  std::uint64_t digest = 0;
  double moved_m = 0.0;     ///< by the odometry, since it was first seen
  double turned_rad = 0.0;  ///< in either direction

  friend bool operator==(const SeenView&, const SeenView&) = default;
};

/// A picture that later ones are compared with.
struct EarlierPicture {
  PictureSketch sketch;
  BodyOffset moved{};       ///< how far the vehicle is by the odometry, seen from where the picture was sent first
  bool came_again = false;  ///< after the vehicle had moved

  friend bool operator==(const EarlierPicture&, const EarlierPicture&) = default;
};

struct LastView {
  static constexpr std::size_t kRemembered = 32;  ///< 16 pictures and what was found in them

  std::vector<SeenView> seen;  ///< all different, newest first
  bool stands_still = false;   ///< the last one was View::kStandsStill
  RecentFrames earlier;        ///< at most one view, in coarser cells, that later ones are compared with
  std::optional<EarlierPicture> earlier_picture;

  /// The vehicle has moved; without odometry it may be anywhere. `is_complete`: as StepMotion::odometry_is_complete(),
  /// so that it says where roads should be seen next.
  void move(const std::optional<Odometry>& odometry, bool is_complete);
  /// Compares the view with earlier ones, and remembers it. `picture`: see StepInput.
  View take_in(const FeatureMap& features, const std::optional<SentPicture>& picture = {});

  friend bool operator==(const LastView&, const LastView&) = default;

 private:
  bool was_seen_before_it_moved(std::uint64_t digest);
  View compared(const PictureSketch& sketch, double side_m);
  bool lies_as_earlier(const FeatureMap& features);
};

}  // namespace roadfix
