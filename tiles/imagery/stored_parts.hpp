// Where a file that leaves blocks out holds any, as GeoTIFFs do that were written with SPARSE_OK.
#pragma once

#include <gdal_priv.h>

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace roadfix {

struct StoredParts {
  std::vector<cv::Rect> parts;  ///< in whole blocks, which one of the bands at least may have
  cv::Point left_out;           ///< a pixel beside them
};

/// nullopt where no block is left out, or all are.
std::optional<StoredParts> stored_parts(GDALDataset& dataset, const std::vector<int>& bands);

}  // namespace roadfix
