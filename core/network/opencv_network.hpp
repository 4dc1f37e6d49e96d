// Runs a network by OpenCV.
#pragma once

#include <mutex>
#include <opencv2/dnn.hpp>
#include <span>
#include <vector>

#include "core/network/network.hpp"

namespace roadfix {

/// cv::dnn::Net holds its intermediate results: each caller borrows one, and a new one is made when all are in use, so
/// that there are never more than there were simultaneous callers.
class OpenCvNetwork : public Network {
 public:
  /// cv::Exception where it is no ONNX file that OpenCV knows.
  explicit OpenCvNetwork(std::span<const unsigned char> onnx);

  cv::Size output_size(cv::Size picture) override;
  cv::Mat run(const cv::Mat& picture) override;

 private:
  cv::dnn::Net made() const;
  cv::dnn::Net borrowed();

  std::vector<unsigned char> onnx_;
  std::mutex mutex_;
  std::vector<cv::dnn::Net> idle_;
};

}  // namespace roadfix
