// The last frames of a track as bytes, beside those of its filter (core/filter/particle_bytes.hpp).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/locate/recent_frames.hpp"

namespace roadfix {

/// Little endian: a magic number with the version, how many frames, then each with its cells; no bytes for no frames.
std::vector<std::byte> to_bytes(const RecentFrames& recent);
/// Throws CorruptData "track-frames-corrupt" for what to_bytes() never writes.
RecentFrames recent_frames_of(std::span<const std::byte> bytes);

}  // namespace roadfix
