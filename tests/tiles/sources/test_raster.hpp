// Small rasters written for a test, pixel by pixel from a function.
#pragma once

#include <gdal_priv.h>

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace roadfix::testing {

struct RasterSpec {
  int width = 64;
  int height = 64;
  int bands = 1;
  GDALDataType type = GDT_Byte;
  int epsg = 32637;  ///< 0 = none
  std::optional<std::array<double, 6>> transform = std::array<double, 6>{400000.0, 1.0, 0.0, 4200064.0, 0.0, -1.0};
  std::vector<std::array<double, 4>> control_points = {};  ///< col, row, x, y; instead of the transform
  std::vector<std::string> rpc = {};                       ///< NAME=value; instead of transform and EPSG code
  std::optional<double> nodata = {};
  std::vector<GDALColorInterp> meanings = {};  ///< of the bands; empty = the driver's own
  std::vector<GDALColorEntry> palette = {};
  std::vector<std::string> creation = {};  ///< options of the GeoTIFF driver
};

/// Transform of pixels of dx, dy, turned clockwise, that puts the middle of the first 300 x 300 at x, y.
std::array<double, 6> around(double x, double y, double dx, double dy, double angle_deg);

/// Value of a pixel of a band (from 1).
using PixelFunction = std::function<double(int band, int col, int row)>;

/// Writes a GeoTIFF. `mask`, if given, becomes its mask band (0 = nothing here).
std::string write_raster(const std::filesystem::path& path, const RasterSpec& spec, const PixelFunction& value,
                         const std::function<bool(int col, int row)>& mask = {});

/// Writes a VRT as gdalbuildvrt makes it, in the finest of the images' pixels.
std::string mosaic_of(const std::filesystem::path& path, const std::vector<std::string>& images);

}  // namespace roadfix::testing
