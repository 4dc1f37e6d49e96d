#include "cli/bench/frame_files.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/detect/image_codec.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"

namespace roadfix::bench {

std::vector<FrameTruth> read_frames_csv(const std::filesystem::path& csv) {
  const auto text = read_file(csv);
  if (!text) throw NotFound("frames-missing", fmt::format("{} cannot be opened", csv.string()));
  return parse_frames_csv(*text);
}

GroundImage read_frame(const std::filesystem::path& folder, const FrameTruth& frame, Border border) {
  constexpr std::int64_t kMaxPixels = 400'000'000;
  const auto refuse = [&](const char* why) {
    throw InvalidInput("image-unreadable", fmt::format("{}: {}", frame.file.string(), why));
  };
  const auto file = read_file(folder / frame.file);
  if (!file) refuse("cannot be opened");
  const std::vector<std::uint8_t> bytes(file->begin(), file->end());
  cv::Mat decoded;
  try {
    decoded = decode_image(bytes, kMaxPixels);
  } catch (const InvalidInput& error) {
    refuse(error.what());
  }
  return frame_image(decoded, frame.gsd_m, border);
}

}  // namespace roadfix::bench
