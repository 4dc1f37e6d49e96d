// A network made ready by oneDNN for pictures of one size.
#pragma once

#include <dnnl.hpp>
#include <mutex>
#include <opencv2/core.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/network/layers.hpp"

namespace roadfix {

/// The weights of a network in the layouts that its plans need, each converted once. Thread-safe.
class OneDnnConstants {
 public:
  /// `values` outlive this.
  dnnl::memory reordered(const std::vector<float>& values, const dnnl::memory::desc& given,
                         const dnnl::memory::desc& layout);

 private:
  struct Constant {
    const float* values = nullptr;
    dnnl::memory memory;
  };
  std::mutex mutex_;
  std::vector<Constant> known_;
};

/// Runs in the thread that calls it. Not thread-safe.
class OneDnnPlan {
 public:
  /// `layers` fit together for this size (output_sides()).
  OneDnnPlan(std::span<const Layer> layers, cv::Size size, OneDnnConstants& constants);

  cv::Size size() const { return size_; }
  /// `picture`: CV_32FC3 of that size. What the last layer gives, CV_32FC1.
  cv::Mat run(const cv::Mat& picture);

 private:
  class Builder;
  struct Step {
    dnnl::primitive primitive;
    std::unordered_map<int, dnnl::memory> arguments;
  };

  cv::Size size_;
  dnnl::stream stream_;
  dnnl::memory picture_;
  dnnl::memory result_;
  std::vector<Step> steps_;
  std::vector<dnnl::memory> buffers_;  ///< behind the memories of steps
};

/// Whether oneDNN is faster than OpenCV here: it needs a processor with AVX2, and a system that lets it write the code
/// that it runs (systemd's MemoryDenyWriteExecute does not).
bool onednn_suits();

}  // namespace roadfix
