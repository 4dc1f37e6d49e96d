// The shift of a source in words.
#pragma once

#include <string>

#include "tiles/store/map_records.hpp"

namespace roadfix::cli {

/// "12 m to the east and 16 m to the north".
std::string directions_of(const SourceShift& shift);

}  // namespace roadfix::cli
