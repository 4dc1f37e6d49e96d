// Windows by which a raster is looked at: a few spread over it, or all of it piece by piece. In pixels of the raster,
// within it.
#pragma once

#include <gdal_priv.h>

#include <opencv2/core.hpp>
#include <vector>

namespace roadfix {

/// 256 windows or about as many, of 64 pixels a side at most, spread evenly over the parts of a raster: 16 x 16 where
/// there is one, at most one in each of many. The same at every call.
std::vector<cv::Rect> spread_windows(const std::vector<cv::Rect>& parts);

/// All of the band, without overlap, in whole blocks of the file of a megapixel or so together.
std::vector<cv::Rect> windows_of_blocks(GDALRasterBand& band);

}  // namespace roadfix
