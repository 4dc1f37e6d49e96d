// The state of a filter as bytes, so that a track goes on after a restart exactly as it would have without one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/filter/filter.hpp"

namespace roadfix {

/// Little endian: a magic number with the version, the counters and averages, then the columns one after the other.
std::vector<std::byte> to_bytes(const FilterState& state);
/// Throws CorruptData ("filter-state-corrupt") for bytes that are not whole, of another version, or hold values that no
/// filter has.
FilterState filter_state_of(std::span<const std::byte> bytes);

}  // namespace roadfix
