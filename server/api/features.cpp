#include "server/api/features.hpp"

#include <iterator>
#include <utility>
#include <variant>

#include "core/detect/sketch.hpp"
#include "core/locate/told_frames.hpp"

namespace roadfix::api {
namespace {

/// Than the first one was, as far as their files tell.
double higher_m(const Features& other, const Features& first) {
  if (!other.camera_in_file || !first.camera_in_file) return 0.0;
  return other.camera_in_file->agl_m - first.camera_in_file->agl_m;
}

}  // namespace

SeenFrame seen_frame(Frame frame, const RoadDetector& detector, std::int64_t max_pixels, bool sketched) {
  const FrameScale& scale = frame.scale;
  FramePixels image = frame_image(std::move(frame.pixels), frame.border);
  const auto sketch = sketched ? std::optional(sketch_of(image.pixels)) : std::nullopt;
  SeenFrame seen{ground_seen(std::move(image), scale.view, detector, static_cast<double>(max_pixels)), sketch};
  if (scale.in_file) seen.camera_in_file = std::get<FrameCamera>(scale.view);
  return seen;
}

Features detected(const SeenFrame& frame, const Detection& detection) {
  const auto start = std::chrono::steady_clock::now();
  FeatureMap map = detect_features(detection.detector, frame.view, detection.cell_m, detection.seed, detection.stop);
  return {std::move(map), std::chrono::steady_clock::now() - start, frame.camera_in_file, detection.detector.describe(),
          frame.sketch};
}

Features together(Features first, std::vector<OtherFeatures> others, double max_cells) {
  std::vector<PlacedFeatures> parts{{std::move(first.map), {}}};
  for (OtherFeatures& other : others) {
    parts.push_back({std::move(other.features.map), other.offset, higher_m(other.features, first)});
    if (first.detect_time) *first.detect_time += other.features.detect_time.value();
  }
  FramesTogether laid = laid_together(parts, max_cells);
  first.map = std::move(laid.features);
  first.left_out = std::move(laid.left_out);
  first.own_frame = std::move(parts.front().features);
  first.others.assign(std::next(parts.begin()), parts.end());
  return first;
}

std::vector<std::size_t> frame_numbers(std::vector<std::size_t> indices) {
  for (std::size_t& index : indices) ++index;
  return indices;
}

}  // namespace roadfix::api
