// Bytes of a road file of unknown kind, through GDAL in memory up to drawn cells.
#include <cpl_vsi.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/units/error.hpp"
#include "tiles/roads/vector_roads.hpp"

namespace roadfix {
namespace {

/// Also of lines that have no place in it.
constexpr int kZone = 32637;

void draw_middle(const std::string& path) {
  constexpr double kCellM = 2.0;
  constexpr int kCells = 32;
  centre_of_roads({path}, {});
  const auto source = open_road_vectors({path}, {}, {}, *UtmZone::from_epsg(kZone), kCellM);
  const GridBox extent = source->extent();
  if (!std::isfinite(extent.width_m()) || !std::isfinite(extent.height_m()) || extent.empty()) std::abort();
  const GridPoint middle = extent.centre();
  const GridBox box{middle, {middle.east_m + kCells * kCellM, middle.north_m + kCells * kCellM}};
  source->read(GridGeometry::covering(box, kCellM), 0);
}

}  // namespace
}  // namespace roadfix

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string path = "/vsimem/fuzzed";
  std::vector<GByte> bytes(data, data + size);
  VSIFCloseL(VSIFileFromMemBuffer(path.c_str(), bytes.data(), bytes.size(), FALSE));
  try {
    roadfix::draw_middle(path);
  } catch (const roadfix::Error&) {
  }
  for (const char* suffix : {"", ".gfs"}) VSIUnlink((path + suffix).c_str());
  return 0;
}
