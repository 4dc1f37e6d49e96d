// A part of a map as a map of its own.
#pragma once

#include "core/locate/map_view.hpp"

namespace roadfix::fly {

/// Cells outside the square of this side about the middle of the map are unobserved.
MapView middle_of(const MapView& map, double side_m);

}  // namespace roadfix::fly
