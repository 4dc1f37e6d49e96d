#include "tiles/world/picture_file.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "core/units/error.hpp"

namespace roadfix::world {
namespace {

constexpr int kFileTile = 256;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw IoFailure("result-unwritable", fmt::format("{}: cannot be written ({})", path.string(), reason));
}

}  // namespace

PictureFile::PictureFile(const std::string& path, const Placement& placement) : file_(path, path + ".partial") {
  require_gdal();
  const GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) fail(path, "this GDAL has no GeoTIFF driver");
  CPLStringList options;
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", std::to_string(kFileTile).c_str());
  options.SetNameValue("BLOCKYSIZE", std::to_string(kFileTile).c_str());
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "2");
  options.SetNameValue("ZLEVEL", "4");
  options.SetNameValue("PHOTOMETRIC", "RGB");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  dataset_.reset(
      driver->Create(file_.unfinished().c_str(), placement.cols, placement.rows, 3, GDT_Byte, options.List()));
  if (!dataset_) fail(path, messages.text());
  std::array<double, 6> transform{
      placement.north_west.east_m, placement.gsd_m, 0.0, placement.north_west.north_m, 0.0, -placement.gsd_m};
  const OGRSpatialReference reference = utm_reference(placement.zone);
  if (dataset_->SetGeoTransform(transform.data()) != CE_None || dataset_->SetSpatialRef(&reference) != CE_None) {
    fail(path, messages.text());
  }
}

void PictureFile::write(cv::Point corner, const cv::Mat3b& pixels) {
  const GdalMessages messages;
  const CPLErr error =
      dataset_->RasterIO(GF_Write, corner.x, corner.y, pixels.cols, pixels.rows, pixels.data, pixels.cols, pixels.rows,
                         GDT_Byte, 3, nullptr, 3, static_cast<GSpacing>(pixels.step[0]), 1, nullptr);
  if (error != CE_None) fail(file_.target(), messages.text());
}

void PictureFile::finish() {
  const GdalMessages messages;
  dataset_->FlushCache(true);
  dataset_.reset();
  if (messages.text() != GdalMessages::kNone) fail(file_.target(), messages.text());
  try {
    file_.finish();
  } catch (const std::filesystem::filesystem_error& error) {
    fail(file_.target(), error.code().message());
  }
}

}  // namespace roadfix::world
