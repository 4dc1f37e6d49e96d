// The kernel for processors that multiply and add bytes (AVX-512 VNNI: most servers since 2020), which Highway 1.0 has
// no operation for: twice as fast as what its AVX-512 gives.
#pragma once

#include <cstddef>
#include <span>

#include "core/match/kernel.hpp"
#include "core/match/kernel_sums.hpp"

namespace roadfix {

bool has_byte_products();
/// Tests of the other versions do without.
void allow_byte_products_for_test(bool allow);

/// As match_sums(), in whole numbers; at all places the footprint stays within the plane. Needs has_byte_products().
void sums_by_byte_products(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                           std::span<IntegerSums> sums);

/// As product_sums(). Needs has_byte_products().
void products_by_byte_products(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                               std::span<std::int64_t> sums);

}  // namespace roadfix
