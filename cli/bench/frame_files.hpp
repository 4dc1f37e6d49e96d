// Real frames with their truth, as files: the CSV and the pictures.
#pragma once

#include <filesystem>
#include <vector>

#include "cli/bench/frames_csv.hpp"
#include "core/detect/frame_image.hpp"

namespace roadfix::bench {

/// Throws NotFound "frames-missing", and as parse_frames_csv.
std::vector<FrameTruth> read_frames_csv(const std::filesystem::path& csv);

/// `folder` is that of the CSV. Throws InvalidInput "image-unreadable".
GroundImage read_frame(const std::filesystem::path& folder, const FrameTruth& frame, Border border);

}  // namespace roadfix::bench
