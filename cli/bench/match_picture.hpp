// Figure 1 of the paper: keypoints of the frame matched with those of the imagery before, and how many are right.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/detect/frame.hpp"
#include "core/detect/orthoimage.hpp"

namespace roadfix::bench {

/// Equally many of both: continuous pixels of the frame's view with (0, 0) at the *centre* of the first pixel as
/// OpenCV's keypoints have it, and metres east and south of the first imagery's outer corner.
struct PointMatches {
  std::vector<cv::Point2f> frame_px;
  std::vector<cv::Point2f> map_m;
};

/// A match further off than this is a wrong one.
inline constexpr double kRightMatchM = 10.0;

/// For each match whether the map's point lies within `tolerance_m` of where the frame's point really is.
/// `origin`: corner that `map_m` is measured from; `truth`: pose of the view's nadir.
std::vector<bool> right_matches(const PointMatches& matches, GridPoint origin, const GroundView& view,
                                const GridPose& truth, double tolerance_m);

/// The imagery of the map beside the frame: right matches green, wrong ones red, all of them red where the truth is
/// not on the map. `imagery` is not empty; its first corner is the origin of the matches.
cv::Mat match_picture(std::span<const Orthoimage> imagery, const GroundView& view, const PointMatches& matches,
                      const std::optional<GridPose>& truth);

}  // namespace roadfix::bench
