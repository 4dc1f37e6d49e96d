// The kernel in Highway's operations: for every processor, in the widest vectors that it has.
#pragma once

#include <cstdint>
#include <span>

#include "core/match/kernel.hpp"
#include "core/match/kernel_sums.hpp"

namespace roadfix {

/// As match_sums(), in whole numbers; at all places the footprint stays within the plane.
void sums_by_highway(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                     std::span<IntegerSums> sums);

/// As product_sums().
void products_by_highway(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                         std::span<std::int64_t> sums);

/// Name of the instruction set that Highway uses ("AVX2", "NEON", ...).
const char* highway_target();

}  // namespace roadfix
