// Real frames with their truth, as files: the CSV and the pictures.
#pragma once

#include <filesystem>
#include <vector>

#include "cli/evaluation/frames_csv.hpp"
#include "core/detect/frame.hpp"
#include "core/detect/frame_image.hpp"
#include "core/detect/orthoimage.hpp"

namespace roadfix::evaluation {

/// Throws NotFound "file-not-found", and what parse_frames_csv() does with the file's name.
std::vector<FrameTruth> read_frames_csv(const std::filesystem::path& csv);

/// The picture alone. `folder` is that of the CSV. Throws NotFound "file-not-found", and what decode_frame() and
/// frame_image() do with the file's name.
FramePixels read_frame(const std::filesystem::path& folder, const FrameTruth& frame, Border border);

/// The ground that its picture shows, as `roadfix fix` with this detector sees it. Throws what ground_seen() does, as
/// InvalidInput with the file's name.
GroundView view_of(const FramePixels& picture, const FrameTruth& frame, const RoadDetector& detector);

/// Of a camera as if it looked straight down through a lens without distortion. Throws likewise.
Footprint footprint_of(const FramePixels& picture, const FrameTruth& frame);

}  // namespace roadfix::evaluation
