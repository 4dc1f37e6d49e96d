// From frames to the feature map that is matched: the same for what a client posts and what a command reads.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/detect/frame.hpp"
#include "core/detect/frame_image.hpp"
#include "core/grid/combine.hpp"
#include "core/grid/picture_sketch.hpp"
#include "core/units/planar.hpp"

namespace roadfix::api {

struct Features {
  FeatureMap map;
  /// Of frames: for which the detector looked at the ground they show. To decode and rectify them comes before it.
  std::optional<std::chrono::duration<double, std::milli>> detect_time{};
  std::optional<FrameCamera> camera_in_file{};  ///< of a frame whose file tells it
  std::optional<std::string> detector{};        ///< of frames: RoadDetector::describe()
  std::optional<PictureSketch> sketch{};        ///< of a frame as it was sent, where asked for
  std::optional<FeatureMap> own_frame{};        ///< where others are laid around it: the first picture by itself
  std::vector<PlacedFeatures> others{};         ///< those that are laid around it
  std::vector<std::size_t> left_out{};          ///< FramesTogether::left_out, the first picture being 0
};

/// What the pixels of a frame measure on the ground.
struct FrameScale {
  FrameView view;
  bool in_file = false;  ///< it is a camera that was read from the picture's file
};

/// A decoded frame and what is told of it.
struct Frame {
  cv::Mat pixels;
  FrameScale scale;
  Border border = Border::kSeen;
};

struct SeenFrame {
  GroundView view;
  std::optional<PictureSketch> sketch{};        ///< where asked for
  std::optional<FrameCamera> camera_in_file{};  ///< where it was read from there
};

/// Throws what frame_image() and ground_seen() do.
SeenFrame seen_frame(Frame frame, const RoadDetector& detector, std::int64_t max_pixels, bool sketched = false);

/// By what roads are looked for in a frame.
struct Detection {
  const RoadDetector& detector;
  double cell_m;
  std::stop_token stop = {};  ///< ends it with Interrupted
  std::uint64_t seed = 1;
  bool sketched = false;  ///< for Features::sketch, which takes milliseconds
};

/// Throws what detect_features() does.
Features detected(const SeenFrame& frame, const Detection& detection);

/// What was seen beside the first picture, and where from.
struct OtherFeatures {
  Features features;
  BodyOffset offset;
};

/// Indices of frames as answers tell them: counted from 1, the first picture.
std::vector<std::size_t> frame_numbers(std::vector<std::size_t> indices);

/// laid_together(), with the camera of the first and the time of all. Throws as that does.
Features together(Features first, std::vector<OtherFeatures> others, double max_cells);

}  // namespace roadfix::api
