// A flight whose places were known, looked for on the map: what a boresight is estimated from.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/detect/boresight.hpp"
#include "core/detect/road_detector.hpp"
#include "core/locate/fix.hpp"
#include "core/locate/map_view.hpp"
#include "core/units/progress.hpp"

namespace roadfix::cli {

struct LookOptions {
  double radius_m = 150.0;  ///< around the told place
  Angle heading_range = Angle::degrees(20.0);
  FixOptions fix;
};

struct FlightFrame {
  std::filesystem::path file;
  std::string reason;                           ///< why it was not found, as Fix::reason or an error's code
  std::optional<BoresightSighting> sighting{};  ///< where it was
};

struct LeftOutFrame {
  std::filesystem::path file;
  std::string reason;  ///< for a person
};

struct Flight {
  std::vector<FlightFrame> frames;     ///< in the order of the table
  std::vector<LeftOutFrame> left_out;  ///< that could not be looked at
  double registration_sigma_m = 0.0;   ///< of the map where it was found, in the mean
};

/// Of a table as evaluation::read_frames_csv() reads it. Throws what that does, Interrupted by options.fix, and
/// InvalidInput "boresight-no-camera" where a frame is told to be rectified, whose attitude nobody knows.
Flight look_for(const std::filesystem::path& csv, const MapView& map, const RoadDetector& detector,
                const LookOptions& options, const OnProgress& progress);

}  // namespace roadfix::cli
