#include "core/match/kernel_vnni.hpp"

#include <cassert>

#if defined(__x86_64__)

// GCC 12 takes the undefined lanes inside its own intrinsics for uninitialized variables (GCC bug 105593).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <immintrin.h>

#include <algorithm>
#include <atomic>
#include <vector>

#define ROADFIX_VNNI __attribute__((target("avx512f,avx512bw,avx512vnni,popcnt")))

namespace roadfix {
namespace {

constexpr std::size_t kStep = 64;
static_assert(2 * PackedFootprint::kAlignment == int{kStep});
// A vector adds at most 4 * 254 * 128 to a 32-bit lane: after so many vectors the lanes are emptied.
constexpr std::size_t kVectorsPerFlush = 8192;
static_assert(kVectorsPerFlush * 4 * 254 * 128 < (std::size_t{1} << 31));

/// The map's cells below two blocks of the footprint. Turned footprints have many short rows: two of them fit a vector.
ROADFIX_VNNI inline __m512i cells_below(const std::uint8_t* nadir, const std::ptrdiff_t* blocks) {
  const __m256i low = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(nadir + blocks[0]));
  const __m256i high = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(nadir + blocks[1]));
  return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}

ROADFIX_VNNI inline std::int64_t emptied(__m512i& lanes) {
  const __m512i low = _mm512_cvtepi32_epi64(_mm512_castsi512_si256(lanes));
  const __m512i high = _mm512_cvtepi32_epi64(_mm512_extracti64x4_epi64(lanes, 1));
  lanes = _mm512_setzero_si512();
  return _mm512_reduce_add_epi64(_mm512_add_epi64(low, high));
}

/// What lies below a place where the map has not observed: taken out of what the footprint's sums begin with.
struct Hidden {
  __m512i l_lanes, ll_lanes;
  std::int64_t n = 0, l = 0, ll = 0;

  ROADFIX_VNNI Hidden() : l_lanes(_mm512_setzero_si512()), ll_lanes(l_lanes) {}
  ROADFIX_VNNI void add(__mmask64 where, __m512i values) {
    const __m512i hidden = _mm512_maskz_mov_epi8(where, values);
    l_lanes = _mm512_dpbusd_epi32(l_lanes, hidden, _mm512_set1_epi8(1));
    ll_lanes = _mm512_dpbusd_epi32(ll_lanes, hidden, _mm512_xor_si512(hidden, _mm512_set1_epi8(-128)));
    n += _mm_popcnt_u64(where);
  }
  ROADFIX_VNNI void flush() {
    if (n == 0) return;
    l += emptied(l_lanes);
    ll += emptied(ll_lanes);
  }
};

/// Several places at once: the processor need not wait for a sum of one before it adds to the others. The instruction
/// wants signed bytes for one factor: cells of the map less 128, 0 where the footprint has not observed.
template <std::size_t kPlaces>
ROADFIX_VNNI void add_up(const MapPlane& map, const PackedFootprint& footprint, std::span<const std::ptrdiff_t> blocks,
                         const PlaneCell* cells, IntegerSums* out) {
  const __m512i high_bit = _mm512_set1_epi8(-128);
  const __m512i unobserved = _mm512_set1_epi8(kUnobserved - 128);
  const std::size_t vectors = blocks.size() / 2;
  const std::uint8_t* nadir[kPlaces];
  __m512i m[kPlaces];
  __m512i mm[kPlaces];
  __m512i ml[kPlaces];
  Hidden hidden[kPlaces];
  for (std::size_t k = 0; k < kPlaces; ++k) {
    nadir[k] = map.at(cells[k].col, cells[k].row);
    m[k] = mm[k] = ml[k] = _mm512_setzero_si512();
    out[k] = {};
  }
  for (std::size_t first = 0; first < vectors; first += kVectorsPerFlush) {
    const std::size_t last = std::min(vectors, first + kVectorsPerFlush);
    for (std::size_t i = first; i < last; ++i) {
      const __m512i l = _mm512_loadu_si512(footprint.values() + i * kStep);
      const __m512i mask = _mm512_loadu_si512(footprint.mask() + i * kStep);
      for (std::size_t k = 0; k < kPlaces; ++k) {
        const __m512i below = cells_below(nadir[k], &blocks[2 * i]);
        __m512i less_128 = _mm512_and_si512(_mm512_xor_si512(below, high_bit), mask);
        const __mmask64 unseen = _mm512_cmpeq_epi8_mask(less_128, unobserved);
        if (unseen != 0) [[unlikely]] {
          hidden[k].add(unseen, l);
          less_128 = _mm512_maskz_mov_epi8(~unseen, less_128);
        }
        m[k] = _mm512_dpbusd_epi32(m[k], below, mask);  // the mask's bytes are 0 and -1
        mm[k] = _mm512_dpbusd_epi32(mm[k], below, less_128);
        ml[k] = _mm512_dpbusd_epi32(ml[k], l, less_128);
      }
    }
    for (std::size_t k = 0; k < kPlaces; ++k) {
      out[k].m -= emptied(m[k]);
      out[k].mm += emptied(mm[k]);
      out[k].ml += emptied(ml[k]);
      hidden[k].flush();
    }
  }
  for (std::size_t k = 0; k < kPlaces; ++k) {
    IntegerSums& sums = out[k];
    sums.n = footprint.observed_cells() - hidden[k].n;
    sums.m -= kUnobserved * hidden[k].n;
    sums.l = footprint.sum() - hidden[k].l;
    sums.mm += 128 * sums.m;
    sums.ll = footprint.sum_of_squares() - hidden[k].ll - 128 * hidden[k].l;
    sums.ml += 128 * sums.l;
  }
}

template <std::size_t kPlaces>
ROADFIX_VNNI void add_products(const MapPlane& map, const PackedFootprint& footprint,
                               std::span<const std::ptrdiff_t> blocks, const PlaneCell* cells, std::int64_t* out) {
  const __m512i high_bit = _mm512_set1_epi8(-128);
  const std::size_t vectors = blocks.size() / 2;
  const std::uint8_t* nadir[kPlaces];
  __m512i ml[kPlaces];
  for (std::size_t k = 0; k < kPlaces; ++k) {
    nadir[k] = map.at(cells[k].col, cells[k].row);
    ml[k] = _mm512_setzero_si512();
    out[k] = 128 * footprint.sum();
  }
  for (std::size_t first = 0; first < vectors; first += kVectorsPerFlush) {
    const std::size_t last = std::min(vectors, first + kVectorsPerFlush);
    for (std::size_t i = first; i < last; ++i) {
      const __m512i l = _mm512_loadu_si512(footprint.values() + i * kStep);
      for (std::size_t k = 0; k < kPlaces; ++k) {
        const __m512i less_128 = _mm512_xor_si512(cells_below(nadir[k], &blocks[2 * i]), high_bit);
        ml[k] = _mm512_dpbusd_epi32(ml[k], l, less_128);
      }
    }
    for (std::size_t k = 0; k < kPlaces; ++k) out[k] += emptied(ml[k]);
  }
}

std::atomic<bool> allowed{true};

}  // namespace

bool has_byte_products() {
  static const bool kHas = __builtin_cpu_supports("avx512vnni") != 0 && __builtin_cpu_supports("avx512bw") != 0;
  return kHas && allowed;
}

void allow_byte_products_for_test(bool allow) { allowed = allow; }

void sums_by_byte_products(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                           std::span<IntegerSums> sums) {
  assert(places.size() == sums.size());
  const std::vector<std::ptrdiff_t> blocks = footprint.block_offsets(map.stride());
  std::size_t i = 0;
  for (; i + 4 <= places.size(); i += 4) add_up<4>(map, footprint, blocks, &places[i], &sums[i]);
  for (; i < places.size(); ++i) add_up<1>(map, footprint, blocks, &places[i], &sums[i]);
}

void products_by_byte_products(const MapPlane& map, const PackedFootprint& footprint, std::span<const PlaneCell> places,
                               std::span<std::int64_t> sums) {
  assert(places.size() == sums.size());
  const std::vector<std::ptrdiff_t> blocks = footprint.block_offsets(map.stride());
  std::size_t i = 0;
  for (; i + 8 <= places.size(); i += 8) add_products<8>(map, footprint, blocks, &places[i], &sums[i]);
  for (; i < places.size(); ++i) add_products<1>(map, footprint, blocks, &places[i], &sums[i]);
}

}  // namespace roadfix

#else

namespace roadfix {

bool has_byte_products() { return false; }

void allow_byte_products_for_test(bool /*allow*/) {}

void sums_by_byte_products(const MapPlane& /*map*/, const PackedFootprint& /*footprint*/,
                           std::span<const PlaneCell> /*places*/, std::span<IntegerSums> /*sums*/) {
  assert(false);
}

void products_by_byte_products(const MapPlane& /*map*/, const PackedFootprint& /*footprint*/,
                               std::span<const PlaneCell> /*places*/, std::span<std::int64_t> /*sums*/) {
  assert(false);
}

}  // namespace roadfix

#endif
