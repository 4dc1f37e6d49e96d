#include "tests/tiles/sources/test_raster.hpp"

#include <cpl_string.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tiles/sources/gdal_session.hpp"

namespace roadfix::testing {
namespace {

void write_band(GDALRasterBand& band, const std::function<double(int col, int row)>& value) {
  const int width = band.GetXSize();
  std::vector<double> line(static_cast<std::size_t>(width));
  for (int row = 0; row < band.GetYSize(); ++row) {
    for (int col = 0; col < width; ++col) line[static_cast<std::size_t>(col)] = value(col, row);
    if (band.RasterIO(GF_Write, 0, row, width, 1, line.data(), width, 1, GDT_Float64, 0, 0, nullptr) != CE_None) {
      throw std::runtime_error("test raster cannot be written");
    }
  }
}

void write_control_points(GDALDataset& dataset, const RasterSpec& spec) {
  OGRSpatialReference reference;
  reference.importFromEPSG(spec.epsg);
  std::string name = "point";
  std::vector<GDAL_GCP> points;
  for (const auto& [col, row, x, y] : spec.control_points) {
    points.push_back({name.data(), name.data(), col, row, x, y, 0.0});
  }
  dataset.SetGCPs(static_cast<int>(points.size()), points.data(), &reference);
}

}  // namespace

std::array<double, 6> around(double x, double y, double dx, double dy, double angle_deg) {
  const double c = std::cos(angle_deg * std::numbers::pi / 180.0);
  const double s = std::sin(angle_deg * std::numbers::pi / 180.0);
  const double half = 150.0;  // pixels
  const std::array<double, 4> m{dx * c, -dy * s, -dx * s, -dy * c};
  return {x - half * (m[0] + m[1]), m[0], m[1], y - half * (m[2] + m[3]), m[2], m[3]};
}

std::string write_raster(const std::filesystem::path& path, const RasterSpec& spec, const PixelFunction& value,
                         const std::function<bool(int col, int row)>& mask) {
  require_gdal();
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
  CPLStringList options;
  for (const std::string& option : spec.creation) options.AddString(option.c_str());
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const DatasetPtr dataset(
      driver->Create(path.c_str(), spec.width, spec.height, spec.bands, spec.type, options.List()));
  if (!dataset) throw std::runtime_error("test raster cannot be created: " + path.string());
  if (!spec.control_points.empty()) {
    write_control_points(*dataset, spec);
  } else if (!spec.rpc.empty()) {
    CPLStringList rpc;
    for (const std::string& entry : spec.rpc) rpc.AddString(entry.c_str());
    dataset->SetMetadata(rpc.List(), "RPC");
  } else if (spec.transform) {
    std::array<double, 6> transform = *spec.transform;
    dataset->SetGeoTransform(transform.data());
  }
  if (spec.epsg != 0 && spec.control_points.empty() && spec.rpc.empty()) {
    OGRSpatialReference reference;
    reference.importFromEPSG(spec.epsg);
    dataset->SetSpatialRef(&reference);
  }
  if (!spec.palette.empty()) {
    GDALColorTable table;
    for (std::size_t i = 0; i < spec.palette.size(); ++i) table.SetColorEntry(static_cast<int>(i), &spec.palette[i]);
    dataset->GetRasterBand(1)->SetColorTable(&table);
  }
  for (int i = 1; i <= spec.bands; ++i) {
    GDALRasterBand& band = *dataset->GetRasterBand(i);
    if (!spec.meanings.empty()) band.SetColorInterpretation(spec.meanings[static_cast<std::size_t>(i - 1)]);
    if (spec.nodata) band.SetNoDataValue(*spec.nodata);
    write_band(band, [&](int col, int row) { return value(i, col, row); });
  }
  if (mask) {
    dataset->CreateMaskBand(GMF_PER_DATASET);
    write_band(*dataset->GetRasterBand(1)->GetMaskBand(),
               [&](int col, int row) { return mask(col, row) ? 255.0 : 0.0; });
  }
  return path.string();
}

std::string mosaic_of(const std::filesystem::path& path, const std::vector<std::string>& images) {
  std::vector<const char*> names;
  for (const std::string& image : images) names.push_back(image.c_str());
  const GdalMessages quiet;
  std::array<const char*, 3> finest{"-resolution", "highest", nullptr};
  GDALBuildVRTOptions* options = GDALBuildVRTOptionsNew(const_cast<char**>(finest.data()), nullptr);
  const DatasetPtr vrt(GDALDataset::FromHandle(
      GDALBuildVRT(path.c_str(), static_cast<int>(names.size()), nullptr, names.data(), options, nullptr)));
  GDALBuildVRTOptionsFree(options);
  return path.string();
}

}  // namespace roadfix::testing
