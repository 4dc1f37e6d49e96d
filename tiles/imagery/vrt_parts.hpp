// Where the images of a VRT lie in it.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

/// Rectangles of the file's pixels that the images of the band fill; of an overview, in its own pixels. What lies
/// beside them reads as 0 and is nothing; so do gaps in VRTs within it. nullopt of other files, and of VRTs that
/// compute their pixels.
std::optional<std::vector<cv::Rect>> filled_parts(GDALDataset& dataset, int band);

/// Clears what of the window (`valid`, CV_8UC1, has its size) lies beside the parts.
void clear_beside(const std::vector<cv::Rect>& parts, cv::Rect window, cv::Mat& valid);

}  // namespace roadfix
