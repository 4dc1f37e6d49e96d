// The flags of a road segment of Overture Maps, as GDAL gives them in JSON text:
// [{"values":["is_tunnel"],"between":[0.2,0.5]}].
#pragma once

#include <string>

namespace roadfix {

/// Share of the segment's length that is a tunnel, under construction or abandoned. Flags without "between", and text
/// that is no such list but names one of these flags, are about all of it.
double hidden_share(const std::string& road_flags);

}  // namespace roadfix
