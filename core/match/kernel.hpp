// The sums of equation (5) for many places of one footprint, vectorised for the processor that runs it.
#pragma once

#include <cstdint>
#include <span>

#include "core/match/correlation.hpp"
#include "core/match/footprint.hpp"
#include "core/match/map_plane.hpp"

namespace roadfix {

/// A cell of a map plane, counted from its first cell; may lie outside.
struct PlaneCell {
  int col = 0;
  int row = 0;
};

/// Puts the nadir cell of the footprint on each of the places and sums over the cells observed in both, exactly (in
/// integers). Places may lie anywhere, but if the footprint leaves the plane (by its reach()), all sums are 0. `sums`
/// is as long as `places`.
void match_sums(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                std::span<MatchSums> sums);

/// The sums of m l alone, in units of 1 / 254^2. All cells of the plane must be observed (not 255), and the footprint
/// must stay within the plane at each of the places. `sums` is as long as `places`.
void product_sums(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                  std::span<std::int64_t> sums);

/// Name of the instruction set in use ("AVX3_VNNI", "AVX2", ...), for reports.
const char* kernel_target();

}  // namespace roadfix
