// Runs a network by oneDNN.
#pragma once

#include <list>
#include <mutex>
#include <vector>

#include "core/network/layers.hpp"
#include "core/network/network.hpp"
#include "core/network/onednn_plan.hpp"

namespace roadfix {

/// Each caller borrows a plan. If none for its size is idle, a new one replaces the one idle for longest, so that there
/// are never more plans than there were simultaneous callers.
class OneDnnNetwork : public Network {
 public:
  /// As read_layers() gives them.
  explicit OneDnnNetwork(std::vector<Layer> layers) : layers_(std::move(layers)) {}

  cv::Size output_size(cv::Size picture) override;
  cv::Mat run(const cv::Mat& picture) override;

 private:
  OneDnnPlan borrowed(cv::Size size);

  std::vector<Layer> layers_;
  OneDnnConstants constants_;
  std::mutex mutex_;
  std::list<OneDnnPlan> idle_;  ///< most recently used first
};

}  // namespace roadfix
