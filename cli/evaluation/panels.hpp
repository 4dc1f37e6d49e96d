// What pictures of the bench and of flights share: colours, and panels beside each other under a line of text.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/grid/cell_array.hpp"

namespace roadfix::evaluation {

struct Panel {
  std::string title;
  cv::Mat pixels;  ///< CV_8UC1 or CV_8UC3
};

/// As CV_8UC3, grey or not.
cv::Mat coloured(const cv::Mat& pixels);

/// The probability that a picture of the cells draws strongest: detectors are seldom sure in places that they have not
/// seen. At least 0.25, so that ground without roads stays dark; 1 where nothing was observed.
double strongest_of(const CellArray& cells);

/// All panels brought to one height; at least one.
cv::Mat side_by_side(const std::vector<Panel>& panels, int height_px);

}  // namespace roadfix::evaluation
