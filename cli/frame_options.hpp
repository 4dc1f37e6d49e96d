// A frame on the command line: what its pixels measure on the ground, said directly or by the camera.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "core/detect/feature_map_codec.hpp"
#include "server/api/altitude_request.hpp"
#include "server/api/features.hpp"

namespace roadfix::cli {

struct FrameOptions {
  double gsd_m = 0.0;  ///< of a frame seen straight from above; 0 = by the camera
  bool camera_in_file = false;
  FrameCamera camera;                   ///< what is told of it; without a height nothing is
  std::optional<double> takeoff_agl_m;  ///< KnownView::takeoff_agl_m, of a photo
  Border border = Border::kSeen;

  bool given() const { return gsd_m > 0.0 || has_camera(); }
  bool has_camera() const { return camera_in_file || camera.agl_m > 0.0; }
};

/// Adds --gsd, the camera's --exif, --fov or --focal-px and what goes with them, and --black-unseen; `options` must
/// live as long as the command. Returns those of which one says that there is a frame.
std::vector<CLI::Option*> add_frame_options(CLI::App& command, FrameOptions& options);

/// Throws CLI::RequiredError where an option says something of a frame and none that there is one.
void require_frame_for(const FrameOptions& options);

/// The ground that the frame in a file shows, in pixels that the detector makes use of. Throws what decode_image,
/// frame_image, rectify and camera_of(DronePicture) throw, InvalidInput "not-a-file" and NotFound "file-not-found";
/// all about the file name it. options.given() must hold.
api::SeenFrame ground_seen(const FrameOptions& options, const std::string& path, const RoadDetector& detector);

/// api::above_takeoff() of the photo in a file. Throws what that throws, naming the file, InvalidInput "not-a-file" and
/// NotFound "file-not-found".
api::AboveTakeoff above_takeoff(const std::string& path, double takeoff_alt_m, const api::AglOf& agl_of);

struct FoundFeatureMap {
  FeatureMap map;
  std::string reader;  ///< of FeatureMapScale
};

/// The feature map in a file, as told where it does not say so itself: see decode_feature_map and
/// feature_map_of; what they throw names the file here. Also throws InvalidInput "not-a-file", "input-kind-missing"
/// where neither tells the cell size, and NotFound "file-not-found".
FoundFeatureMap feature_map_in(const std::string& path, const ToldScale& told);

}  // namespace roadfix::cli
