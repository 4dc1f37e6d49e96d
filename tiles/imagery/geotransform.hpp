// The six numbers that lead from pixels to the plane of a raster's reference system.
#pragma once

#include <gdal_priv.h>

#include <array>
#include <optional>

namespace roadfix {

/// x = t[0] + t[1] col + t[2] row, y = t[3] + t[4] col + t[5] row.
using Geotransform = std::array<double, 6>;

/// nullopt where the raster has none or one whose coordinates are columns and rows, as images have that were only given
/// a reference system. GDAL's transformer takes neither, and goes by control points or rational polynomials.
inline std::optional<Geotransform> geotransform_of(GDALDataset& dataset) {
  Geotransform t{};
  if (dataset.GetGeoTransform(t.data()) != CE_None) return std::nullopt;
  if (t == Geotransform{0.0, 1.0, 0.0, 0.0, 0.0, 1.0} || t == Geotransform{0.0, 1.0, 0.0, 0.0, 0.0, -1.0}) {
    return std::nullopt;
  }
  return t;
}

}  // namespace roadfix
