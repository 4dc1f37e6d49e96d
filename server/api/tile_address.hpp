// The address of a tile in the path of a request.
#pragma once

#include <string>

#include "tiles/mercator/web_mercator.hpp"

namespace roadfix::api {

/// Throws NotFound ("tile-not-found") for anything that is no tile of the square, and for numbers that begin with 0.
mercator::TileAddress parse_tile(const std::string& z, const std::string& x, const std::string& y);

}  // namespace roadfix::api
