// The JSON beside a user's own network: any bytes are either a description in range or InvalidInput.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/detect/network_description.hpp"
#include "core/units/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto network =
        roadfix::parse_network_description(std::string_view(reinterpret_cast<const char*>(data), size));
    if (!(network.gsd_m > 0.0) || network.tile_px < 2 * network.overlap_px) std::abort();
  } catch (const roadfix::InvalidInput&) {
    return 0;
  }
  return 0;
}
