#include "core/match/kernel_highway.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/match/kernel_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

constexpr std::size_t kBlock = PackedFootprint::kAlignment;

#if HWY_TARGET == HWY_SCALAR  // processors without the byte operations (SSE2 only)

template <std::size_t kPlaces, bool kAllObserved>
void add_up(const MapPlane& map, const PackedFootprint& footprint, std::span<const std::ptrdiff_t> blocks,
            const PlaneCell* cells, IntegerSums* out) {
  for (std::size_t k = 0; k < kPlaces; ++k) {
    out[k] = {};
    for (std::size_t i = 0; i < blocks.size() * kBlock; ++i) {
      const std::int64_t m = map.at(cells[k].col, cells[k].row)[blocks[i / kBlock] + static_cast<int>(i % kBlock)];
      const std::int64_t l = footprint.values()[i];
      if (m == kUnobserved || footprint.mask()[i] == 0) continue;
      ++out[k].n;
      out[k].m += m;
      out[k].l += l;
      out[k].mm += m * m;
      out[k].ll += l * l;
      out[k].ml += m * l;
    }
  }
}

template <std::size_t kPlaces>
void add_products(const MapPlane& map, const PackedFootprint& footprint, std::span<const std::ptrdiff_t> blocks,
                  const PlaneCell* cells, std::int64_t* out) {
  for (std::size_t k = 0; k < kPlaces; ++k) {
    out[k] = 0;
    for (std::size_t i = 0; i < blocks.size() * kBlock; ++i) {
      const std::int64_t m = map.at(cells[k].col, cells[k].row)[blocks[i / kBlock] + static_cast<int>(i % kBlock)];
      out[k] += m * footprint.values()[i];
    }
  }
}

#else

namespace hn = hwy::HWY_NAMESPACE;

// A footprint's spans are padded to blocks, so longer vectors are not used.
constexpr hn::CappedTag<std::uint8_t, PackedFootprint::kAlignment> kBytes;
constexpr hn::Repartition<std::int16_t, decltype(kBytes)> kShorts;
constexpr hn::Repartition<std::int32_t, decltype(kBytes)> kInts;
constexpr hn::Repartition<std::uint64_t, decltype(kBytes)> kLongs;
using Bytes = hn::Vec<decltype(kBytes)>;
using Ints = hn::Vec<decltype(kInts)>;
using Longs = hn::Vec<decltype(kLongs)>;

// A block adds at most 8 * 254^2 to a 32-bit lane: after so many the lanes are emptied.
constexpr std::size_t kBlocksPerFlush = 4096;
static_assert(kBlocksPerFlush * 8 * 254 * 254 < (std::size_t{1} << 31));

/// Bytes as shorts, in the order that is the same for all.
struct Shorts {
  hn::Vec<decltype(kShorts)> low, high;

  HWY_ATTR HWY_INLINE explicit Shorts(Bytes bytes)
      : low(hn::BitCast(kShorts, hn::InterleaveLower(kBytes, bytes, hn::Zero(kBytes)))),
        high(hn::BitCast(kShorts, hn::InterleaveUpper(kBytes, bytes, hn::Zero(kBytes)))) {}
};

/// Of products, in lanes of 32 bits.
struct ProductSum {
  Ints even, odd;

  HWY_ATTR HWY_INLINE ProductSum() : even(hn::Zero(kInts)), odd(even) {}
  HWY_ATTR HWY_INLINE void add(const Shorts& a, const Shorts& b) {
    even = hn::ReorderWidenMulAccumulate(kInts, a.low, b.low, even, odd);
    even = hn::ReorderWidenMulAccumulate(kInts, a.high, b.high, even, odd);
  }

  HWY_ATTR HWY_INLINE std::int64_t emptied() {
    // Pairs of lanes are widened before they are added: two lanes together may exceed 32 bits.
    const auto widened = [](Ints v) HWY_ATTR {
      const auto lanes = hn::BitCast(kLongs, v);
      return hn::Add(hn::ShiftRight<32>(lanes), hn::And(lanes, hn::Set(kLongs, 0xFFFFFFFFu)));
    };
    const Longs sum = hn::Add(widened(even), widened(odd));
    even = odd = hn::Zero(kInts);
    return static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(kLongs, sum)));
  }
};

HWY_ATTR HWY_INLINE std::int64_t total(Longs sum) {
  return static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(kLongs, sum)));
}

/// What lies below a place where the map has not observed: taken out of what the footprint's sums begin with.
struct Hidden {
  Longs n, l;
  ProductSum ll;

  HWY_ATTR HWY_INLINE Hidden() : n(hn::Zero(kLongs)), l(n) {}
  HWY_ATTR void add(Bytes where, Bytes values) {
    const Bytes hidden = hn::And(where, values);
    n = hn::Add(n, hn::SumsOf8(hn::And(where, hn::Set(kBytes, 1))));
    l = hn::Add(l, hn::SumsOf8(hidden));
    ll.add(Shorts(hidden), Shorts(hidden));
  }
};

/// Several places at once share the footprint's values, and the processor need not wait for a sum of one before it adds
/// to that of another. Where all of the map is observed, nothing hidden needs to be looked for.
template <std::size_t kPlaces, bool kAllObserved>
HWY_ATTR void add_up(const MapPlane& map, const PackedFootprint& footprint, std::span<const std::ptrdiff_t> blocks,
                     const PlaneCell* cells, IntegerSums* out) {
  const Bytes unobserved = hn::Set(kBytes, kUnobserved);
  const std::size_t step = hn::Lanes(kBytes);
  const std::uint8_t* nadir[kPlaces];
  Longs m_sum[kPlaces];
  ProductSum mm[kPlaces];
  ProductSum ml[kPlaces];
  Hidden hidden[kPlaces];
  for (std::size_t k = 0; k < kPlaces; ++k) {
    nadir[k] = map.at(cells[k].col, cells[k].row);
    m_sum[k] = hn::Zero(kLongs);
    out[k] = {footprint.observed_cells(), 0, footprint.sum(), 0, footprint.sum_of_squares(), 0};
  }
  for (std::size_t first = 0; first < blocks.size(); first += kBlocksPerFlush) {
    const std::size_t last = std::min(blocks.size(), first + kBlocksPerFlush);
    for (std::size_t block = first; block < last; ++block) {
      for (std::size_t i = 0; i < kBlock; i += step) {
        const Bytes mask = hn::Load(kBytes, footprint.mask() + block * kBlock + i);
        const Bytes values = hn::Load(kBytes, footprint.values() + block * kBlock + i);
        const Shorts l(values);
        Bytes m[kPlaces];
        Bytes highest = hn::Zero(kBytes);
        for (std::size_t k = 0; k < kPlaces; ++k) {
          m[k] = hn::And(hn::LoadU(kBytes, nadir[k] + blocks[block] + i), mask);
          if constexpr (!kAllObserved) highest = hn::Max(highest, m[k]);
        }
        if (!kAllObserved && !hn::AllFalse(kBytes, hn::Eq(highest, unobserved))) [[unlikely]] {
          for (std::size_t k = 0; k < kPlaces; ++k) {
            const Bytes unseen = hn::VecFromMask(kBytes, hn::Eq(m[k], unobserved));
            hidden[k].add(unseen, values);
            m[k] = hn::AndNot(unseen, m[k]);
          }
        }
        for (std::size_t k = 0; k < kPlaces; ++k) {
          const Shorts below(m[k]);
          m_sum[k] = hn::Add(m_sum[k], hn::SumsOf8(m[k]));
          mm[k].add(below, below);
          ml[k].add(below, l);
        }
      }
    }
    for (std::size_t k = 0; k < kPlaces; ++k) {
      out[k].mm += mm[k].emptied();
      out[k].ml += ml[k].emptied();
      out[k].ll -= hidden[k].ll.emptied();
    }
  }
  for (std::size_t k = 0; k < kPlaces; ++k) {
    out[k].n -= total(hidden[k].n);
    out[k].m = total(m_sum[k]);
    out[k].l -= total(hidden[k].l);
  }
}

/// Unobserved cells of the footprint have the value 0.
template <std::size_t kPlaces>
HWY_ATTR void add_products(const MapPlane& map, const PackedFootprint& footprint,
                           std::span<const std::ptrdiff_t> blocks, const PlaneCell* cells, std::int64_t* out) {
  const std::size_t step = hn::Lanes(kBytes);
  const std::uint8_t* nadir[kPlaces];
  ProductSum ml[kPlaces];
  for (std::size_t k = 0; k < kPlaces; ++k) {
    nadir[k] = map.at(cells[k].col, cells[k].row);
    out[k] = 0;
  }
  for (std::size_t first = 0; first < blocks.size(); first += kBlocksPerFlush) {
    const std::size_t last = std::min(blocks.size(), first + kBlocksPerFlush);
    for (std::size_t block = first; block < last; ++block) {
      for (std::size_t i = 0; i < kBlock; i += step) {
        const Shorts l(hn::Load(kBytes, footprint.values() + block * kBlock + i));
        for (std::size_t k = 0; k < kPlaces; ++k) {
          ml[k].add(Shorts(hn::LoadU(kBytes, nadir[k] + blocks[block] + i)), l);
        }
      }
    }
    for (std::size_t k = 0; k < kPlaces; ++k) out[k] += ml[k].emptied();
  }
}

#endif

void products_at(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                 std::span<std::int64_t> sums) {
  const std::vector<std::ptrdiff_t> blocks = footprint.block_offsets(map.stride());
  std::size_t i = 0;
  for (; i + 4 <= places.size(); i += 4) add_products<4>(map, footprint, blocks, &places[i], &sums[i]);
  for (; i < places.size(); ++i) add_products<1>(map, footprint, blocks, &places[i], &sums[i]);
}

template <bool kAllObserved>
void sums_on(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
             std::span<IntegerSums> sums) {
  constexpr std::size_t kAtOnce = kAllObserved ? 4 : 2;
  const std::vector<std::ptrdiff_t> blocks = footprint.block_offsets(map.stride());
  std::size_t i = 0;
  for (; i + kAtOnce <= places.size(); i += kAtOnce) {
    add_up<kAtOnce, kAllObserved>(map, footprint, blocks, &places[i], &sums[i]);
  }
  for (; i < places.size(); ++i) add_up<1, kAllObserved>(map, footprint, blocks, &places[i], &sums[i]);
}

void sums_at(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
             std::span<IntegerSums> sums) {
  if (map.all_observed()) {
    sums_on<true>(map, footprint, places, sums);
  } else {
    sums_on<false>(map, footprint, places, sums);
  }
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <cassert>

namespace roadfix {

HWY_EXPORT(products_at);
HWY_EXPORT(sums_at);
HWY_EXPORT(target_name);

void sums_by_highway(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                     std::span<IntegerSums> sums) {
  assert(places.size() == sums.size());
  HWY_DYNAMIC_DISPATCH(sums_at)(map, footprint, places, sums);
}

void products_by_highway(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                         std::span<std::int64_t> sums) {
  assert(places.size() == sums.size());
  HWY_DYNAMIC_DISPATCH(products_at)(map, footprint, places, sums);
}

const char* highway_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace roadfix

#endif  // HWY_ONCE
