// Frames of a camera that looks straight down, cut out of a finished picture, and the truth about each.
#pragma once

#include <opencv2/core.hpp>
#include <stop_token>
#include <string>
#include <vector>

#include "core/units/planar.hpp"
#include "tiles/world/random.hpp"
#include "tiles/world/settings.hpp"

namespace roadfix::world {

/// Uniform over position and heading, so that all of the turned footprint lies in the picture.
std::vector<GridPose> draw_poses(const WorldSettings& settings, const Placement& placement, Random& random);

/// Row 0 is the forward edge, columns run to the right, the centre lies at the pose. Red, green, blue. Throws what
/// open_dataset throws, and IoFailure "world-unreadable".
cv::Mat3b cut_frame(const std::string& picture, const Placement& placement, const GridPose& pose, double footprint_m);

/// FOLDER/frame_01.png ... and FOLDER/frames.csv: file, lat, lon, heading_deg (from true north), gsd_m. The folder is
/// there. Throws IoFailure "result-unwritable", Interrupted.
void write_frames(const std::string& picture, const std::string& folder, const WorldSettings& settings,
                  const Placement& placement, const std::vector<GridPose>& poses, const std::stop_token& stop);

}  // namespace roadfix::world
