#include "tiles/export/window_tiff.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <vector>

#include "core/units/error.hpp"
#include "tiles/export/map_dataset.hpp"
#include "tiles/export/probability_pixel.hpp"
#include "tiles/sources/gdal_session.hpp"
#include "tiles/sources/memory_file.hpp"

namespace roadfix {
namespace {

void require(bool done) {
  if (!done) throw IoFailure("export-failed", fmt::format("GDAL cannot write the window: {}", CPLGetLastErrorMsg()));
}

std::vector<float> probabilities(const CellArray& cells) {
  std::vector<float> values;
  values.reserve(cells.cells().size());
  for (const Cell cell : cells.cells()) values.push_back(probability_pixel(cell));
  return values;
}

}  // namespace

std::string window_tiff(const CellArray& cells, const UtmZone& zone, const std::array<double, 6>& geotransform,
                        const MapInfo& info) {
  require_gdal();
  const MemoryFile file(".tif");
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  require(driver != nullptr);
  std::array<const char*, 2> options{"COMPRESS=DEFLATE", nullptr};
  DatasetPtr dataset(
      driver->Create(file.path(), cells.cols(), cells.rows(), 1, GDT_Float32, const_cast<char**>(options.data())));
  require(dataset != nullptr);
  const OGRSpatialReference reference = utm_reference(zone);
  auto transform = geotransform;
  require(dataset->SetSpatialRef(&reference) == CE_None && dataset->SetGeoTransform(transform.data()) == CE_None);
  describe(*dataset, PixelKind::kProbability, info);
  GDALRasterBand* band = dataset->GetRasterBand(1);
  require(band->SetNoDataValue(static_cast<double>(kNoData)) == CE_None);
  std::vector<float> values = probabilities(cells);
  require(band->RasterIO(GF_Write, 0, 0, cells.cols(), cells.rows(), values.data(), cells.cols(), cells.rows(),
                         GDT_Float32, 0, 0) == CE_None);
  dataset.reset();  // closing writes the directory
  return file.bytes();
}

}  // namespace roadfix
