// Truth of real frames: a CSV with a header line, columns file, lat, lon, heading_deg, gsd_m in any order, and
// optionally sequence and time_s; others are ignored.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geodesy/geo_pose.hpp"

namespace roadfix::bench {

struct FrameTruth {
  std::filesystem::path file;  ///< relative to the CSV
  GeoPose pose;                ///< of the frame's centre
  double gsd_m = 1.0;
  std::string sequence;          ///< frames of one flight share it; empty where the CSV does not say
  std::optional<double> time_s;  ///< when it was taken, from any one moment on
};

/// Throws InvalidInput ("frames-csv") naming line and column.
std::vector<FrameTruth> parse_frames_csv(std::string_view text);

}  // namespace roadfix::bench
