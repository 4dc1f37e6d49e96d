// Runs road networks on the processor.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <span>

namespace roadfix {

/// Input of 1 x 3 x rows x columns, output of 1 x 1 x rows x columns. Thread-safe.
class Network {
 public:
  virtual ~Network() = default;
  /// The size of run()'s result for a picture of this size. cv::Exception for a size that the network cannot take.
  virtual cv::Size output_size(cv::Size picture) = 0;
  /// `picture`: CV_32FC3, of a size that output_size() takes. The output as CV_32FC1.
  virtual cv::Mat run(const cv::Mat& picture) = 0;
};

/// oneDNN, where onednn_suits(), for networks of the layers that layers.hpp knows, each call in its caller's thread;
/// OpenCV for all others. cv::Exception where `onnx` is no ONNX file that OpenCV can read.
std::unique_ptr<Network> load_network(std::span<const unsigned char> onnx);

}  // namespace roadfix
