// Truth of real frames: a CSV with a header line, columns file, lat, lon, heading_deg in any order, and in each row
// either gsd_m, or agl_m or alt_m with fov_deg or focal_px and what else is known of the camera (roll_deg, pitch_deg,
// attitude_sigma_deg, principal_px, lens, distortion: named and measured as in FrameCamera, several numbers separated
// by blanks). Optionally sequence and time_s; others are ignored.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/detect/frame_camera.hpp"
#include "core/geodesy/geo_pose.hpp"

namespace roadfix::evaluation {

struct FrameTruth {
  std::filesystem::path file;    ///< relative to the CSV
  GeoPose pose;                  ///< of the UAV; below it lies the centre of a frame seen straight from above
  FrameView view;                ///< of a camera with alt_m: its agl_m is 0 until somebody knows the ground below
  std::optional<double> alt_m;   ///< height above the sea, where that above ground is not told
  std::string sequence;          ///< frames of one flight share it; empty where the CSV does not say
  std::optional<double> time_s;  ///< when it was taken, from any one moment on
};

/// Throws InvalidInput ("frames-csv") naming line and column.
std::vector<FrameTruth> parse_frames_csv(std::string_view text);

}  // namespace roadfix::evaluation
