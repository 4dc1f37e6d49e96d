#include "core/match/kernel_highway.hpp"

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/match/kernel_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR  // processors without the byte operations (SSE2 only)

void sums_over_cells(const std::uint8_t* nadir, std::ptrdiff_t stride, const PackedFootprint& footprint,
                     IntegerSums& sums) {
  for (const PackedFootprint::Span& span : footprint.spans()) {
    const std::uint8_t* map = nadir + span.row * stride + span.first_col;
    for (std::size_t i = 0; i < static_cast<std::size_t>(span.cells); ++i) {
      const std::int64_t m = map[i];
      const std::int64_t l = footprint.values()[span.offset + i];
      if (m == kUnobserved || footprint.mask()[span.offset + i] == 0) continue;
      ++sums.n;
      sums.m += m;
      sums.l += l;
      sums.mm += m * m;
      sums.ll += l * l;
      sums.ml += m * l;
    }
  }
}

std::int64_t products_over_cells(const std::uint8_t* nadir, std::ptrdiff_t stride, const PackedFootprint& footprint) {
  std::int64_t sum = 0;
  for (const PackedFootprint::Span& span : footprint.spans()) {
    const std::uint8_t* map = nadir + span.row * stride + span.first_col;
    for (std::size_t i = 0; i < static_cast<std::size_t>(span.cells); ++i) {
      sum += std::int64_t{1} * map[i] * footprint.values()[span.offset + i];
    }
  }
  return sum;
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

// A vector of bytes adds at most 4 * 254^2 to a 32-bit lane: after so many vectors the lanes are emptied.
constexpr std::size_t kVectorsPerFlush = 8192;
static_assert(kVectorsPerFlush * 4 * 254 * 254 < (std::size_t{1} << 31));
static_assert(PackedFootprint::kMaxCols / 16 <= kVectorsPerFlush, "a row fits between two flushes");

HWY_ATTR HWY_INLINE void add_products(Bytes a, Bytes b, Ints& sum0, Ints& sum1) {
  const Bytes zero = hn::Zero(kBytes);
  const auto low_a = hn::BitCast(kShorts, hn::InterleaveLower(kBytes, a, zero));
  const auto low_b = hn::BitCast(kShorts, hn::InterleaveLower(kBytes, b, zero));
  const auto high_a = hn::BitCast(kShorts, hn::InterleaveUpper(kBytes, a, zero));
  const auto high_b = hn::BitCast(kShorts, hn::InterleaveUpper(kBytes, b, zero));
  sum0 = hn::ReorderWidenMulAccumulate(kInts, low_a, low_b, sum0, sum1);
  sum0 = hn::ReorderWidenMulAccumulate(kInts, high_a, high_b, sum0, sum1);
}

HWY_ATTR HWY_INLINE std::int64_t emptied(Ints& sum0, Ints& sum1) {
  // Pairs of lanes are widened before they are added: two lanes together may exceed 32 bits.
  const auto widened = [](Ints v) HWY_ATTR {
    const auto lanes = hn::BitCast(kLongs, v);
    return hn::Add(hn::ShiftRight<32>(lanes), hn::And(lanes, hn::Set(kLongs, 0xFFFFFFFFu)));
  };
  const Longs sum = hn::Add(widened(sum0), widened(sum1));
  sum0 = sum1 = hn::Zero(kInts);
  return static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(kLongs, sum)));
}

HWY_ATTR HWY_INLINE std::int64_t total(Longs sum) {
  return static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(kLongs, sum)));
}

/// Where all map cells under the footprint were observed: only three sums depend on the place. False if one was not.
HWY_ATTR bool sums_on_observed_map(const std::uint8_t* nadir, std::ptrdiff_t stride, const PackedFootprint& footprint,
                                   IntegerSums& sums) {
  const Bytes unobserved = hn::Set(kBytes, kUnobserved);
  const std::size_t step = hn::Lanes(kBytes);
  Longs m_sum = hn::Zero(kLongs);
  Ints mm0 = hn::Zero(kInts);
  Ints mm1 = hn::Zero(kInts);
  Ints ml0 = hn::Zero(kInts);
  Ints ml1 = hn::Zero(kInts);
  std::size_t vectors = 0;
  sums = {footprint.observed_cells(), 0, footprint.sum(), 0, footprint.sum_of_squares(), 0};
  for (const PackedFootprint::Span& span : footprint.spans()) {
    const std::uint8_t* map = nadir + span.row * stride + span.first_col;
    const std::uint8_t* values = footprint.values() + span.offset;
    const std::uint8_t* mask = footprint.mask() + span.offset;
    const auto cells = static_cast<std::size_t>(span.cells);
    auto holes = hn::Zero(kBytes);
    if (vectors + cells / step + 1 > kVectorsPerFlush) {
      sums.mm += emptied(mm0, mm1);
      sums.ml += emptied(ml0, ml1);
      vectors = 0;
    }
    for (std::size_t i = 0; i < cells; i += step, ++vectors) {
      const Bytes m = hn::And(hn::LoadU(kBytes, map + i), hn::Load(kBytes, mask + i));
      holes = hn::Max(holes, m);
      m_sum = hn::Add(m_sum, hn::SumsOf8(m));
      add_products(m, m, mm0, mm1);
      add_products(m, hn::Load(kBytes, values + i), ml0, ml1);
    }
    if (!hn::AllFalse(kBytes, hn::Eq(holes, unobserved))) return false;
  }
  sums.m = total(m_sum);
  sums.mm += emptied(mm0, mm1);
  sums.ml += emptied(ml0, ml1);
  return true;
}

HWY_ATTR void sums_on_partial_map(const std::uint8_t* nadir, std::ptrdiff_t stride, const PackedFootprint& footprint,
                                  IntegerSums& sums) {
  const Bytes unobserved = hn::Set(kBytes, kUnobserved);
  const Bytes one = hn::Set(kBytes, 1);
  const std::size_t step = hn::Lanes(kBytes);
  Longs n_sum = hn::Zero(kLongs);
  Longs m_sum = hn::Zero(kLongs);
  Longs l_sum = hn::Zero(kLongs);
  Ints mm0 = hn::Zero(kInts);
  Ints mm1 = hn::Zero(kInts);
  Ints ll0 = hn::Zero(kInts);
  Ints ll1 = hn::Zero(kInts);
  Ints ml0 = hn::Zero(kInts);
  Ints ml1 = hn::Zero(kInts);
  std::size_t vectors = 0;
  sums = {};
  for (const PackedFootprint::Span& span : footprint.spans()) {
    const std::uint8_t* map = nadir + span.row * stride + span.first_col;
    const std::uint8_t* values = footprint.values() + span.offset;
    const std::uint8_t* mask = footprint.mask() + span.offset;
    const auto cells = static_cast<std::size_t>(span.cells);
    if (vectors + cells / step + 1 > kVectorsPerFlush) {
      sums.mm += emptied(mm0, mm1);
      sums.ll += emptied(ll0, ll1);
      sums.ml += emptied(ml0, ml1);
      vectors = 0;
    }
    for (std::size_t i = 0; i < cells; i += step, ++vectors) {
      const Bytes raw = hn::LoadU(kBytes, map + i);
      const Bytes hidden = hn::VecFromMask(kBytes, hn::Eq(raw, unobserved));
      const Bytes both = hn::AndNot(hidden, hn::Load(kBytes, mask + i));
      const Bytes m = hn::And(raw, both);
      const Bytes l = hn::And(hn::Load(kBytes, values + i), both);
      n_sum = hn::Add(n_sum, hn::SumsOf8(hn::And(both, one)));
      m_sum = hn::Add(m_sum, hn::SumsOf8(m));
      l_sum = hn::Add(l_sum, hn::SumsOf8(l));
      add_products(m, m, mm0, mm1);
      add_products(l, l, ll0, ll1);
      add_products(m, l, ml0, ml1);
    }
  }
  sums.n = total(n_sum);
  sums.m = total(m_sum);
  sums.l = total(l_sum);
  sums.mm += emptied(mm0, mm1);
  sums.ll += emptied(ll0, ll1);
  sums.ml += emptied(ml0, ml1);
}

void sums_over_cells(const std::uint8_t* nadir, std::ptrdiff_t stride, const PackedFootprint& footprint,
                     IntegerSums& sums) {
  if (!sums_on_observed_map(nadir, stride, footprint, sums)) sums_on_partial_map(nadir, stride, footprint, sums);
}

/// Unobserved cells of the footprint have the value 0.
HWY_ATTR std::int64_t products_over_cells(const std::uint8_t* nadir, std::ptrdiff_t stride,
                                          const PackedFootprint& footprint) {
  const std::size_t step = hn::Lanes(kBytes);
  Ints sum0 = hn::Zero(kInts);
  Ints sum1 = hn::Zero(kInts);
  std::int64_t sum = 0;
  std::size_t vectors = 0;
  for (const PackedFootprint::Span& span : footprint.spans()) {
    const std::uint8_t* map = nadir + span.row * stride + span.first_col;
    const std::uint8_t* values = footprint.values() + span.offset;
    const auto cells = static_cast<std::size_t>(span.cells);
    if (vectors + cells / step + 1 > kVectorsPerFlush) {
      sum += emptied(sum0, sum1);
      vectors = 0;
    }
    for (std::size_t i = 0; i < cells; i += step, ++vectors) {
      add_products(hn::LoadU(kBytes, map + i), hn::Load(kBytes, values + i), sum0, sum1);
    }
  }
  return sum + emptied(sum0, sum1);
}

#endif

void products_at(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                 std::span<std::int64_t> sums) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    sums[i] = products_over_cells(map.at(places[i].col, places[i].row), map.stride(), footprint);
  }
}

void sums_at(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
             std::span<IntegerSums> sums) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    sums_over_cells(map.at(places[i].col, places[i].row), map.stride(), footprint, sums[i]);
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
