// Windows by which a raster is looked at: a few spread over it, or all of it piece by piece. In pixels of the raster,
// within it.
#pragma once

#include <gdal_priv.h>

#include <opencv2/core.hpp>
#include <vector>

namespace roadfix {

/// 16 x 16 windows of 64 pixels a side at most, spread evenly, the same at every call.
std::vector<cv::Rect> spread_windows(cv::Size image);

/// All of the band, without overlap, in whole blocks of the file of a megapixel or so together.
std::vector<cv::Rect> windows_of_blocks(GDALRasterBand& band);

}  // namespace roadfix
