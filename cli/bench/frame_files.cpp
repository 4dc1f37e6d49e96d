#include "cli/bench/frame_files.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "core/units/error.hpp"

namespace roadfix::bench {

std::vector<FrameTruth> read_frames_csv(const std::filesystem::path& csv) {
  std::ifstream in(csv, std::ios::binary);
  if (!in) throw NotFound("frames-missing", fmt::format("{} cannot be opened", csv.string()));
  return parse_frames_csv(std::string{std::istreambuf_iterator<char>(in), {}});
}

GroundImage read_frame(const std::filesystem::path& folder, const FrameTruth& frame, Border border) {
  const cv::Mat decoded = cv::imread((folder / frame.file).string(), cv::IMREAD_UNCHANGED);
  if (decoded.empty()) {
    throw InvalidInput("image-unreadable", fmt::format("{} is not an image that can be read", frame.file.string()));
  }
  return frame_image(decoded, frame.gsd_m, border);
}

}  // namespace roadfix::bench
