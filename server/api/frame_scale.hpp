// What the pixels of a frame measure on the ground, as its request says it: directly, by its camera, or by the drone's
// notes in its file.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/detect/frame_camera.hpp"
#include "server/api/features.hpp"
#include "server/api/fields.hpp"
#include "tiles/imagery/drone_picture.hpp"

namespace roadfix::api {

const std::vector<std::string>& frame_scale_fields();

/// Of "fov_deg" and "agl_m".
inline constexpr Range kFieldOfView{0.0, 179.0, true};
inline constexpr Range kHeightAboveGround{0.0, kHighestAglM, true};

/// Height above ground, where told. Throws InvalidField.
std::optional<double> told_agl_m(const Fields& fields);

/// A field that no client sends: KnownView::takeoff_agl_m of the request's photos, as take_altitude() sets it.
inline constexpr const char* kTakeoffAgl = "takeoff_agl_m";

/// `picture` are the bytes of the frame's file. Throws InvalidField, and what camera_of(DronePicture) throws.
FrameScale parse_frame_scale(const Fields& fields, std::span<const std::uint8_t> picture);

/// By the drone's notes alone. Throws what camera_of(DronePicture) throws.
FrameScale scale_in_file(std::span<const std::uint8_t> picture, const KnownView& known);

/// A camera that was read from a file, so that its roll and pitch are told, by the names of the fields that would tell
/// it.
nlohmann::json to_json(const FrameCamera& camera);

}  // namespace roadfix::api
