#include "tiles/imagery/raster_reference.hpp"

#include <fmt/format.h>

#include <optional>

#include "core/units/error.hpp"
#include "tiles/imagery/geotransform.hpp"
#include "tiles/sources/prj_file.hpp"

namespace roadfix {
namespace {

bool is_placed(GDALDataset& raster) {
  if (geotransform_of(raster)) return true;
  return raster.GetGCPCount() >= 3 || raster.GetMetadata("RPC") != nullptr;
}

std::optional<OGRSpatialReference> crs_within(GDALDataset& raster) {
  const OGRSpatialReference* own = raster.GetSpatialRef();
  if (own == nullptr) own = raster.GetGCPSpatialRef();
  if (own != nullptr && lies_on_earth(*own)) {
    OGRSpatialReference crs = *own;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return crs;
  }
  if (raster.GetMetadata("RPC") != nullptr) return wgs84_reference();
  return std::nullopt;
}

}  // namespace

OGRSpatialReference reference_of(GDALDataset& raster, const std::string& path, const std::string& told) {
  if (!is_placed(raster)) {
    throw InvalidInput(
        "image-without-georeference",
        fmt::format(
            "{}: nothing says where on Earth it lies; give a GeoTIFF, or put a world file beside it "
            "(.jgw, .pgw, .tfw), and a .prj file that names its reference system (ingest also takes --crs EPSG:...)",
            path));
  }
  if (!told.empty()) return parse_crs(told);
  if (const auto own = crs_within(raster)) return *own;
  if (const auto beside = crs_beside(path)) return *beside;
  throw InvalidInput("image-without-georeference",
                     fmt::format("{}: has coordinates but no reference system{}; name it in a .prj file beside it, or "
                                 "with --crs of ingest, for example --crs EPSG:32637",
                                 path, not_on_earth(raster.GetSpatialRef())));
}

}  // namespace roadfix
