// From a picture of the ground to the network's input, and from its output to cells.
#pragma once

#include "core/detect/network_description.hpp"
#include "core/detect/road_detector.hpp"

namespace roadfix {

/// A picture at the network's ground sample distance. Its first corner is the image's; its sides are padded to the
/// network's multiple with unobserved pixels.
struct NetworkPicture {
  cv::Mat pixels;    ///< CV_32FC3 in the network's channel order, (grey level - mean) / std; 0 where not seen
  cv::Mat observed;  ///< CV_8UC1, nonzero where any of a pixel was seen
};

/// Throws InvalidInput "image-shape" when the image's parts differ in size or have another type than GroundImage says.
NetworkPicture network_picture(const GroundImage& image, const NetworkDescription& network);

/// The network's output (CV_32FC1) as probability in [0, 1].
cv::Mat calibrated(const cv::Mat& output, const NetworkDescription& network);

/// Probabilities of cells of `step_m` from the image's first corner on, averaged (or interpolated, where cell_m is
/// smaller) over what was seen into RoadDetector::detect's cells.
CellArray road_cells(const cv::Mat& probability, double step_m, const GroundImage& image, double cell_m);

}  // namespace roadfix
