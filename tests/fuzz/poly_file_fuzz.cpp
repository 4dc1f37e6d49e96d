// Polygon filters of Osmosis as users bring them.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/units/error.hpp"
#include "tiles/roads/poly_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto polygons = roadfix::parse_poly(text, "fuzz.poly");
    for (const OGRPolygon* polygon : *polygons) {
      if (polygon->getExteriorRing()->getNumPoints() < 3) std::abort();
    }
  } catch (const roadfix::InvalidInput&) {
  }
  return 0;
}
