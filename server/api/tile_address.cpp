#include "server/api/tile_address.hpp"

#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::api {
namespace {

int parse_index(const std::string& text, int end) {
  const auto value = as_number<int>(text);
  if (!value || *value < 0 || *value >= end || std::to_string(*value) != text) {  // 7 and 007 would be one tile
    throw NotFound("tile-not-found",
                   "tiles are /{z}/{x}/{y}.png with z from 0 to 24 and x, y from 0 to 2^z - 1, without leading zeros");
  }
  return *value;
}

}  // namespace

mercator::TileAddress parse_tile(const std::string& z, const std::string& x, const std::string& y) {
  const int zoom = parse_index(z, mercator::kMaxZoom + 1);
  return {zoom, parse_index(x, 1 << zoom), parse_index(y, 1 << zoom)};
}

}  // namespace roadfix::api
