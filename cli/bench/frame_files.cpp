#include "cli/bench/frame_files.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/detect/image_codec.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"

namespace roadfix::bench {
namespace {

constexpr std::int64_t kMaxPixels = 400'000'000;

[[noreturn]] void refuse(const FrameTruth& frame, const std::string& code, const std::string& why) {
  throw InvalidInput(code, fmt::format("{}: {}", frame.file.string(), why));
}

auto naming(const FrameTruth& frame, const auto& compute) {
  try {
    return compute();
  } catch (const InvalidInput& error) {
    refuse(frame, error.code(), error.what());
  } catch (const LimitExceeded& error) {
    refuse(frame, error.code(), error.what());
  }
}

}  // namespace

std::vector<FrameTruth> read_frames_csv(const std::filesystem::path& csv) {
  const auto text = read_file(csv);
  if (!text) throw NotFound("frames-missing", fmt::format("{} cannot be opened", csv.string()));
  return parse_frames_csv(*text);
}

GroundImage read_frame(const std::filesystem::path& folder, const FrameTruth& frame, Border border) {
  const auto file = read_file(folder / frame.file);
  if (!file) refuse(frame, "image-unreadable", "cannot be opened");
  const std::vector<std::uint8_t> bytes(file->begin(), file->end());
  cv::Mat decoded;
  try {
    decoded = decode_image(bytes, kMaxPixels);
  } catch (const InvalidInput& error) {
    refuse(frame, "image-unreadable", error.what());
  }
  return frame_image(decoded, frame.gsd_m, border);
}

GroundView view_of(const GroundImage& picture, const FrameTruth& frame, const RoadDetector& detector) {
  return naming(frame, [&] { return ground_seen(picture, frame.camera, detector, static_cast<double>(kMaxPixels)); });
}

Footprint footprint_of(const GroundImage& picture, const FrameTruth& frame) {
  const cv::Size size = picture.pixels.size();
  const double gsd_m = frame.camera ? naming(frame, [&] { return nominal_gsd_m(*frame.camera, size); }) : frame.gsd_m;
  return {size.width * gsd_m, size.height * gsd_m};
}

}  // namespace roadfix::bench
