// Pictures beside each other under a line of text.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace roadfix::bench {

struct Panel {
  std::string title;
  cv::Mat pixels;  ///< CV_8UC1 or CV_8UC3
};

/// All panels brought to one height; at least one.
cv::Mat side_by_side(const std::vector<Panel>& panels, int height_px);

}  // namespace roadfix::bench
