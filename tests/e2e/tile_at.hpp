// The address of a tile by what it shows.
#pragma once

#include <string>

#include "tiles/mercator/web_mercator.hpp"

namespace roadfix::testing {

/// "16/X/Y.png": of zoom 16, below ".../tiles/".
inline std::string tile_at(LatLon place) {
  const mercator::MercatorPixel pixel = mercator::mercator_pixel(place, 16);
  return "16/" + std::to_string(static_cast<int>(pixel.x / 256)) + "/" +
         std::to_string(static_cast<int>(pixel.y / 256)) + ".png";
}

}  // namespace roadfix::testing
