#include "cli/evaluation/frame_files.hpp"

#include <string>
#include <vector>

#include "cli/limits.hpp"
#include "core/detect/feature_map_codec.hpp"
#include "core/units/bytes.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"

namespace roadfix::evaluation {

std::vector<FrameTruth> read_frames_csv(const std::filesystem::path& csv) {
  const std::string text = read_named_file(csv);
  return said_of(csv.string(), [&] { return parse_frames_csv(text); });
}

FramePixels read_frame(const std::filesystem::path& folder, const FrameTruth& frame, Border border) {
  const std::string file = read_named_file(folder / frame.file);
  return said_of(frame.file.string(),
                 [&] { return frame_image(decode_frame(bytes_of(file), cli::kMaxPixels), border); });
}

GroundView view_of(const FramePixels& picture, const FrameTruth& frame, const RoadDetector& detector) {
  return said_of(frame.file.string(),
                 [&] { return ground_seen(picture, frame.view, detector, static_cast<double>(cli::kMaxPixels)); });
}

Footprint footprint_of(const FramePixels& picture, const FrameTruth& frame) {
  const cv::Size size = picture.pixels.size();
  const double gsd_m = said_of(frame.file.string(), [&] { return nominal_gsd_m(frame.view, size); });
  return {size.width * gsd_m, size.height * gsd_m};
}

}  // namespace roadfix::evaluation
