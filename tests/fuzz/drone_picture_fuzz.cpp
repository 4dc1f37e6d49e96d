// What a drone wrote into a picture: any bytes are XMP, and any texts tags, of which some say something.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "tiles/sources/drone_picture.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const roadfix::Tags tags = roadfix::tags_of_xmp(std::string(reinterpret_cast<const char*>(data), size));
  const auto picture = roadfix::drone_picture({tags, tags, {4000, 3000}});
  if (picture.place && !(std::abs(picture.place->lat_deg) <= 90.0 && std::abs(picture.place->lon_deg) <= 180.0)) {
    std::abort();
  }
  if (picture.focal_px && !(*picture.focal_px > 0.0)) std::abort();
  return 0;
}
