// All that a track is between two steps as bytes, so that it goes on after a restart exactly as it would have without
// one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/track/tracker.hpp"

namespace roadfix {

/// Of a track that has begun. Little endian: a magic number with the version, then words of eight bytes, but for the
/// cells of frames.
std::vector<std::byte> to_bytes(const TrackerState& state);
/// Throws CorruptData ("track-store-corrupt") for what to_bytes() never writes.
TrackerState tracker_state_of(std::span<const std::byte> bytes);

}  // namespace roadfix
