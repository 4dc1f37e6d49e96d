// From which height a frame was taken: above ground, or above the sea instead.
#pragma once

#include <functional>
#include <optional>

#include "core/locate/altitude.hpp"
#include "server/api/fields.hpp"

namespace roadfix::api {

/// Height above ground at a height above the sea, both in metres.
using AglOf = std::function<double(double above_sea_m)>;

/// Of a camera's frame, by `agl_m`, or by `alt_m` alone: the fields have a height above ground from then on, the one
/// that `agl_of` gives. nullopt where the size of what is sent is told otherwise. Throws InvalidField, and what
/// `agl_of` throws.
std::optional<Altitude> take_altitude(Fields& fields, const AglOf& agl_of);

}  // namespace roadfix::api
