// What a drone wrote into a picture: any bytes are a JPEG, or XMP, and any texts tags, of which some say something.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "tiles/imagery/drone_picture.hpp"

namespace {

void read(const roadfix::PictureTags& tags) {
  const roadfix::DronePicture picture = roadfix::drone_picture(tags);
  if (picture.place && !(std::abs(picture.place->lat_deg) <= 90.0 && std::abs(picture.place->lon_deg) <= 180.0)) {
    std::abort();
  }
  if (picture.focal_px && !(*picture.focal_px > 0.0)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const roadfix::Tags tags = roadfix::tags_of_xmp(std::string(reinterpret_cast<const char*>(data), size));
  read({tags, tags, {4000, 3000}});
  read(roadfix::read_picture_tags(std::span(data, size)));
  return 0;
}
