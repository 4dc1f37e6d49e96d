// The hstore text in which GDAL's OSM driver packs all tags that have no column of their own:
// "lanes"=>"2","name"=>"a \"quoted\" one".
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace roadfix {

/// Keys and values with escapes undone. A NULL value is left out. Text that is no hstore gives what stood before the
/// damage.
std::map<std::string, std::string, std::less<>> parse_hstore(std::string_view text);

}  // namespace roadfix
