// Bytes of an image of unknown kind, through GDAL in memory up to pixels of the map's plane.
#include <cpl_vsi.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geodesy/utm.hpp"
#include "core/units/error.hpp"
#include "tiles/imagery/mosaic.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr const char* kPath = "/vsimem/fuzzed.tif";
  std::vector<GByte> bytes(data, data + size);
  VSIFCloseL(VSIFileFromMemBuffer(kPath, bytes.data(), bytes.size(), FALSE));
  try {
    const roadfix::UtmZone zone = *roadfix::UtmZone::from_epsg(32637);
    const roadfix::Mosaic mosaic({kPath}, {.crs = "EPSG:32637", .collar = {}}, roadfix::ValueRule::kPicture, zone);
    const roadfix::GridPoint corner = mosaic.extent().min;
    mosaic.view({corner, {corner.east_m + 32.0, corner.north_m + 32.0}}, 1.0);
  } catch (const roadfix::Error&) {
  }
  VSIUnlink(kPath);
  return 0;
}
