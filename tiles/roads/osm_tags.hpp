// The text in which GDAL's OSM driver and others pack all tags that have no attribute of their own: hstore,
// "lanes"=>"2","name"=>"a \"quoted\" one", or JSON, {"lanes":"2"}.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace roadfix {

using TagMap = std::map<std::string, std::string, std::less<>>;

/// Keys and values with escapes undone. A NULL value is left out. Text that is no hstore gives what stood before the
/// damage.
TagMap parse_hstore(std::string_view text);

/// An object of JSON, else hstore. A null is left out; damaged JSON gives nothing.
TagMap parse_tags(std::string_view text);

}  // namespace roadfix
