#include "core/network/onednn_network.hpp"

#include <algorithm>

namespace roadfix {

cv::Size OneDnnNetwork::output_size(cv::Size picture) {
  const auto sides = output_sides(layers_, {picture.height, picture.width});
  if (!sides) CV_Error(cv::Error::StsUnmatchedSizes, "its layers do not fit together");
  return {(*sides)[1], (*sides)[0]};
}

cv::Mat OneDnnNetwork::run(const cv::Mat& picture) {
  OneDnnPlan plan = borrowed(picture.size());
  cv::Mat result = plan.run(picture);
  const std::scoped_lock lock(mutex_);
  idle_.push_front(std::move(plan));
  return result;
}

OneDnnPlan OneDnnNetwork::borrowed(cv::Size size) {
  {
    const std::scoped_lock lock(mutex_);
    const auto found = std::ranges::find(idle_, size, &OneDnnPlan::size);
    if (found != idle_.end()) {
      OneDnnPlan plan = std::move(*found);
      idle_.erase(found);
      return plan;
    }
    if (!idle_.empty()) idle_.pop_back();
  }
  return {layers_, size, constants_};
}

}  // namespace roadfix
