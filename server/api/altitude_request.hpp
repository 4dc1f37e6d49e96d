// From which height a frame was taken: above ground, or above the sea instead.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/locate/altitude.hpp"
#include "server/api/content.hpp"
#include "server/api/features.hpp"

namespace roadfix::api {

/// Height above ground at a height above the sea, both in metres.
using AglOf = std::function<double(double above_sea_m)>;

/// Names that may be in the query of a request whose frame takes its size from the ground of a map.
const std::vector<std::string>& altitude_fields();

/// Of a camera's frame, by `agl_m`, or by `alt_m` alone; of a drone's photo by these, too, or by `takeoff_alt_m` and
/// its file: the fields tell a height above ground from then on, the one that `agl_of` gives. nullopt where the size of
/// what is sent is told otherwise: that of a photo by its file, which counts for more than `alt_m` where the map knows
/// no heights ("terrain-missing" of `agl_of`). Throws InvalidField, what `agl_of` throws and what above_takeoff() does.
std::optional<Altitude> take_altitude(Content& content, const AglOf& agl_of);

/// A drone's photo whose take-off lay so high above the sea.
struct AboveTakeoff {
  Altitude altitude;
  double takeoff_agl_m = 0.0;  ///< KnownView::takeoff_agl_m by which its camera has the height above ground of that
};

/// By the height above the take-off that the photo's file tells. Throws InvalidInput "camera-not-in-file" where it does
/// not, and what `agl_of` throws.
AboveTakeoff above_takeoff(std::span<const std::uint8_t> photo, double takeoff_alt_m, const AglOf& agl_of);

/// By the height above ground of the camera that a photo's file told; nullopt where none did.
std::optional<Altitude> altitude_in_file(const Features& features);

}  // namespace roadfix::api
