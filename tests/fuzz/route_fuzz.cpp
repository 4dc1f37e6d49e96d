// Plans and routes of ground stations: any bytes are places on the Earth, or InvalidInput.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/routes/route.hpp"
#include "core/units/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto route = roadfix::routes::parse_route({reinterpret_cast<const char*>(data), size});
    if (route.places.size() < 2) std::abort();
    for (const auto& place : route.places) {
      const roadfix::LatLon at = place.position;
      if (!(std::abs(at.lat_deg) <= 90.0 && std::abs(at.lon_deg) <= 180.0)) std::abort();
      if (place.height && !std::isfinite(place.height->metres)) std::abort();
    }
  } catch (const roadfix::InvalidInput&) {
    return 0;
  }
  return 0;
}
