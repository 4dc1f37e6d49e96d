#include "core/network/opencv_network.hpp"

namespace roadfix {

OpenCvNetwork::OpenCvNetwork(std::span<const unsigned char> onnx) : onnx_(onnx.begin(), onnx.end()) {
  idle_.push_back(made());
}

cv::Size OpenCvNetwork::output_size(cv::Size picture) { return run(cv::Mat::zeros(picture, CV_32FC3)).size(); }

cv::Mat OpenCvNetwork::run(const cv::Mat& picture) {
  cv::dnn::Net net = borrowed();
  net.setInput(cv::dnn::blobFromImage(picture));
  const cv::Mat blob = net.forward();
  if (blob.dims != 4 || blob.size[0] != 1 || blob.size[1] != 1 || blob.type() != CV_32FC1) {
    CV_Error(cv::Error::StsUnmatchedSizes, "the output is not 1 x 1 x rows x columns");
  }
  cv::Mat result = cv::Mat(blob.size[2], blob.size[3], CV_32FC1, const_cast<float*>(blob.ptr<float>())).clone();
  const std::scoped_lock lock(mutex_);
  idle_.push_back(net);
  return result;
}

cv::dnn::Net OpenCvNetwork::made() const {
  cv::dnn::Net net = cv::dnn::readNetFromONNX(onnx_);
  net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  return net;
}

cv::dnn::Net OpenCvNetwork::borrowed() {
  {
    const std::scoped_lock lock(mutex_);
    if (!idle_.empty()) {
      cv::dnn::Net net = idle_.back();
      idle_.pop_back();
      return net;
    }
  }
  return made();
}

}  // namespace roadfix
