#include "core/match/kernel.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "core/match/kernel_highway.hpp"
#include "core/match/kernel_sums.hpp"
#include "core/match/kernel_vnni.hpp"

namespace roadfix {
namespace {

MatchSums scaled(const IntegerSums& s) {
  constexpr double kUnit = 1.0 / 254.0;
  constexpr double kSquare = kUnit * kUnit;
  return {s.n,
          static_cast<double>(s.m) * kUnit,
          static_cast<double>(s.l) * kUnit,
          static_cast<double>(s.mm) * kSquare,
          static_cast<double>(s.ll) * kSquare,
          static_cast<double>(s.ml) * kSquare};
}

/// Whether a footprint of that reach stays within the plane.
bool within(const MapPlane& map, int reach, PlaneCell place) {
  return place.col >= reach && place.row >= reach && place.col < map.cols() - reach && place.row < map.rows() - reach;
}

/// At all places the footprint stays within the plane.
void sums_within(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                 std::span<MatchSums> out) {
  std::vector<IntegerSums> sums(places.size());
  if (has_byte_products()) {
    sums_by_byte_products(map, footprint, places, sums);
  } else {
    sums_by_highway(map, footprint, places, sums);
  }
  std::ranges::transform(sums, out.begin(), scaled);
}

}  // namespace

void match_sums(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                std::span<MatchSums> sums) {
  assert(places.size() == sums.size());
  std::size_t begin = 0;
  while (begin < places.size()) {
    std::size_t end = begin;
    while (end < places.size() && within(map, footprint.reach(), places[end])) ++end;
    sums_within(map, footprint, places.subspan(begin, end - begin), sums.subspan(begin, end - begin));
    if (end < places.size()) sums[end++] = MatchSums{};
    begin = end;
  }
}

void product_sums(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                  std::span<std::int64_t> sums) {
  assert(places.size() == sums.size());
  assert(std::ranges::all_of(places, [&](PlaneCell place) { return within(map, footprint.reach(), place); }));
  if (has_byte_products()) {
    products_by_byte_products(map, footprint, places, sums);
  } else {
    products_by_highway(map, footprint, places, sums);
  }
}

const char* kernel_target() { return has_byte_products() ? "AVX3_VNNI" : highway_target(); }

}  // namespace roadfix
