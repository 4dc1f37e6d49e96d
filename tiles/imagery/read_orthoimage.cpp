#include "tiles/imagery/read_orthoimage.hpp"

#include <fmt/format.h>

#include "core/units/error.hpp"
#include "tiles/imagery/georeference.hpp"
#include "tiles/imagery/mosaic.hpp"

namespace roadfix {

Orthoimage read_orthoimage(const std::string& path, const UtmZone& zone) {
  constexpr double kLargest = 4e8;
  const Mosaic mosaic({path}, {}, ValueRule::kPicture, zone);
  const GridBox box = mosaic.extent();
  const double gsd_m = mosaic.gsd_m();
  const double pixels = box.width_m() / gsd_m * (box.height_m() / gsd_m);
  if (pixels > kLargest) {
    throw LimitExceeded("imagery-too-large",
                        fmt::format("{}: {:.0f} megapixels are more than the {:.0f} that are read at once; cut it up",
                                    path, pixels / 1e6, kLargest / 1e6));
  }
  return {mosaic.view(box, gsd_m), {box.min.east_m, box.max.north_m}};
}

UtmZone zone_of_image(const std::string& path, const RasterOptions& options) {
  return UtmZone::containing(centre_of(RasterFile(path, options)));
}

}  // namespace roadfix
