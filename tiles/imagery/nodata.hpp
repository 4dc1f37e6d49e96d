// The values by which a raster says that a pixel holds nothing.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

/// What the band declares; nullopt where it declares none.
std::optional<double> nodata_of(GDALRasterBand& band);

/// False for overviews made before a value was marked as nodata, or kept beside a file whose mask lies within.
bool hides_as_much(GDALRasterBand& overview, GDALRasterBand& band);

/// Sets `valid` (CV_8UC1) to 0 where every channel of `values` (CV_8U or CV_32F) that declares a nodata value has it,
/// and where any value is no number.
void clear_nodata(const cv::Mat& values, const std::vector<std::optional<double>>& nodata, cv::Mat& valid);

}  // namespace roadfix
