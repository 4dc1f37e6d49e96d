// What a client posts to be matched or detected: a feature map or a frame, with the values that describe it.
#pragma once

#include <chrono>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/detect/frame_camera.hpp"
#include "core/detect/road_detector.hpp"
#include "core/grid/feature_map.hpp"
#include "server/api/content.hpp"
#include "server/api/limits.hpp"

namespace roadfix::api {

/// Names that may be in the query of a request with a feature map or frame.
const std::vector<std::string>& feature_fields();
/// Those of a frame alone.
const std::vector<std::string>& frame_fields();
/// Members of a JSON body beside these: the picture, or the cells of a window or detection as the service gives them.
const std::vector<std::string>& picture_members();
/// Whether the ground was seen, rather than nothing. A picture of no bytes was, and is refused when it is read.
bool shows_ground(const Content& content);

/// Throws InvalidField ("missing-parameter") for a field that describes what was seen, where nothing was sent: a
/// picture that was forgotten is not to pass for a flight without one.
void require_nothing_seen(const Fields& fields);

struct Features {
  FeatureMap map;
  std::optional<std::chrono::duration<double, std::milli>> detect_time;  ///< of a frame
  std::optional<FrameCamera> camera_in_file;                             ///< of a frame with exif=true
  std::optional<FeatureMap> own_frame{};  ///< where others are laid around it: the request's picture by itself
};

/// How well the nadir is known as the client says, 1 sigma per axis: it knows more than a camera's description tells.
std::optional<double> told_nadir_sigma_m(const Fields& fields);

/// The feature map, detected if it is a frame. `default_cell_m` is the cell size for frames that name none. Detection
/// ends with Interrupted when a stop is requested.
Features features_of(const Content& content, const RoadDetector& detector, double default_cell_m, const Limits& limits,
                     const std::stop_token& stop);
/// The same of what is a frame for sure, whatever the fields say of a feature map.
Features detected(const Content& content, const RoadDetector& detector, double default_cell_m, const Limits& limits,
                  const std::stop_token& stop);

}  // namespace roadfix::api
