#include "core/detect/tiling.hpp"

#include <tbb/parallel_for_each.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <opencv2/imgproc.hpp>

namespace roadfix {

int tile_side(int length, const TilePlan& plan) {
  assert(plan.tile > 0 && 2 * plan.overlap <= plan.tile);
  if (length <= plan.tile) return length;
  const auto ceil_of = [](int a, int b) { return (a + b - 1) / b; };
  const int count = ceil_of(length - plan.overlap, plan.tile - plan.overlap);
  const int even = ceil_of(length + (count - 1) * plan.overlap, count);
  return std::min(plan.tile, ceil_of(even, plan.multiple) * plan.multiple);
}

std::vector<int> tile_starts(int length, const TilePlan& plan) {
  const int side = tile_side(length, plan);
  std::vector<int> starts{0};
  while (starts.back() + side < length) {
    starts.push_back(std::min(starts.back() + side - plan.overlap, length - side));
  }
  return starts;
}

std::vector<float> blend_weights(int cells, int overlap_cells) {
  // A picture's own border has one tile only, and any positive weight stands for all of it.
  constexpr float kMin = 1e-4F;
  const float quiet = static_cast<float>(overlap_cells) / 4.0F;
  const float ramp = std::max(1.0F, static_cast<float>(overlap_cells) / 2.0F);
  std::vector<float> weights(static_cast<std::size_t>(cells), 1.0F);
  for (int i = 0; i < cells && overlap_cells > 0; ++i) {
    const float end_distance = static_cast<float>(std::min(i, cells - 1 - i)) + 0.5F;
    weights[static_cast<std::size_t>(i)] = std::clamp((end_distance - quiet) / ramp, kMin, 1.0F);
  }
  return weights;
}

namespace {

/// Smallest rectangle inside `tile` around the wanted pixels that begins and ends at multiples; empty without any.
cv::Rect part_to_run(const cv::Mat& wanted, const cv::Rect& tile, int multiple) {
  const cv::Rect box = cv::boundingRect(wanted(tile));
  const int left = box.x / multiple * multiple;
  const int top = box.y / multiple * multiple;
  const auto up = [&](int end) { return (end + multiple - 1) / multiple * multiple; };
  return cv::Rect(left, top, up(box.x + box.width) - left, up(box.y + box.height) - top) + tile.tl();
}

}  // namespace

cv::Mat blend_tiles(const cv::Mat& wanted, const TilePlan& plan, const std::function<cv::Mat(const cv::Rect&)>& run) {
  struct Part {
    cv::Rect tile;
    cv::Rect wanted;
    cv::Mat result;
  };
  std::vector<Part> parts;
  const cv::Size side(tile_side(wanted.cols, plan), tile_side(wanted.rows, plan));
  for (const int top : tile_starts(wanted.rows, plan)) {
    for (const int left : tile_starts(wanted.cols, plan)) {
      const cv::Rect tile({left, top}, side);
      const cv::Rect part = part_to_run(wanted, tile, plan.multiple);
      if (!part.empty()) parts.push_back({tile, part, {}});
    }
  }
  // Isolated: while it waits here, a thread must not begin other work of the caller, such as another picture.
  tbb::this_task_arena::isolate(
      [&] { tbb::parallel_for_each(parts, [&](Part& part) { part.result = run(part.wanted); }); });
  const auto in_cells = [&](const cv::Rect& pixels) {
    return cv::Rect(pixels.tl() / plan.stride, cv::Size(pixels.width / plan.stride, pixels.height / plan.stride));
  };
  const cv::Size cells(wanted.cols / plan.stride, wanted.rows / plan.stride);
  cv::Mat sum = cv::Mat::zeros(cells, CV_32FC1);
  cv::Mat weight_sum = cv::Mat::zeros(cells, CV_32FC1);
  const auto down = blend_weights(side.height / plan.stride, plan.overlap / plan.stride);
  const auto right = blend_weights(side.width / plan.stride, plan.overlap / plan.stride);
  const cv::Mat weight_of_tile = cv::Mat(down, true) * cv::Mat(right, true).t();
  for (const Part& part : parts) {
    const cv::Rect place = in_cells(part.wanted);
    assert(part.result.size() == place.size() && part.result.type() == CV_32FC1);
    const cv::Mat weight = weight_of_tile(place - in_cells(part.tile).tl());
    sum(place) += part.result.mul(weight);
    weight_sum(place) += weight;
  }
  cv::Mat blended;
  cv::divide(sum, weight_sum, blended);  // where nothing was added OpenCV answers 0
  blended.setTo(0, weight_sum == 0);
  return blended;
}

}  // namespace roadfix
