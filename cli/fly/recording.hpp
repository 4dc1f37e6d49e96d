// A flight that was recorded: real frames with their true poses, told to the filters as those of a simulated flight.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/fly/flight.hpp"
#include "core/detect/frame_image.hpp"
#include "core/detect/road_detector.hpp"
#include "core/units/progress.hpp"

namespace roadfix::fly {

struct RecordedFrame {
  GridPose truth;
  double time_s = 0.0;  ///< since a step before the first frame
  Footprint footprint;  ///< of a camera as if it looked straight down
  Observation observation;
  std::optional<Altitude> altitude;  ///< of a camera: as told, and the height above ground that made what it shows
};

struct Recording {
  std::string sequence;  ///< as in the CSV; may be empty
  std::vector<RecordedFrame> frames;
};

struct RecordingOptions {
  Border border = Border::kSeen;
  const RoadDetector* detector = nullptr;  ///< null = frames are kept as pictures, for a detector elsewhere
  double cell_m = 2.0;                     ///< of the feature maps
  double step_s = 1.0;                     ///< between frames whose times are not recorded
  std::size_t max_frames = 0;              ///< of a sequence; 0 = all
  /// Height above the ground below a point, of what is so high above the sea.
  std::function<double(GridPoint below, double above_sea_m)> agl_m;
};

/// The flights of a CSV as evaluation::read_frames_csv reads it, one for each sequence, in its order. Each frame has
/// its roads detected once, of which `progress` tells; one with a height above the sea by the ground below its true
/// place, as by a track that is sure of its place. Throws as evaluation::read_frames_csv, evaluation::read_frame and
/// options.agl_m, and InvalidInput "recording-time" where a sequence's times run backwards.
std::vector<Recording> read_recordings(const std::filesystem::path& csv, const UtmZone& zone,
                                       const RecordingOptions& options, const OnProgress& progress = {});

/// Frames are lost as the plan says, and its odometry's errors are added to the true way from frame to frame. The seed
/// draws both; `seen` is called after each step.
Flight replay(const Recording& recording, const FlightPlan& plan, std::uint64_t seed,
              const std::function<void()>& seen);

}  // namespace roadfix::fly
