// The heights of a map's ground in words.
#pragma once

#include <string>

#include "tiles/store/map_records.hpp"

namespace roadfix::cli {

/// "cells of 32 m, 534 to 1203 m above the sea, known on 98 % of the map". All of it is 100 %, and less is less.
std::string heights_text(const TerrainStatus& terrain);

}  // namespace roadfix::cli
