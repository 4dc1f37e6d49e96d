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
#include <array>
#include <atomic>
#include <vector>

#define ROADFIX_VNNI __attribute__((target("avx512f,avx512bw,avx512vnni,popcnt")))

namespace roadfix {
namespace {

constexpr std::size_t kStep = 64;
static_assert(kStep == Footprint::kAlignment);
// A vector adds at most 4 * 254 * 128 to a 32-bit lane: after so many vectors the lanes are emptied.
constexpr std::size_t kVectorsPerFlush = 8192;
static_assert(kVectorsPerFlush * 4 * 254 * 128 < (std::size_t{1} << 31));

/// A vector's worth of the footprint, in the order of its values.
struct Piece {
  std::ptrdiff_t offset = 0;  ///< of the map's cell below its first one from that below the nadir
  __mmask64 observed = 0;
};

ROADFIX_VNNI std::vector<Piece> pieces_of(const Footprint& footprint, std::ptrdiff_t stride) {
  std::vector<Piece> pieces;
  for (const Footprint::Row& row : footprint.rows()) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(row.cells); i += kStep) {
      const std::ptrdiff_t offset = row.row * stride + row.first_col + static_cast<std::ptrdiff_t>(i);
      pieces.push_back({offset, _mm512_movepi8_mask(_mm512_load_si512(footprint.mask() + pieces.size() * kStep))});
    }
  }
  return pieces;
}

ROADFIX_VNNI inline std::int64_t emptied(__m512i& lanes) {
  const __m512i low = _mm512_cvtepi32_epi64(_mm512_castsi512_si256(lanes));
  const __m512i high = _mm512_cvtepi32_epi64(_mm512_extracti64x4_epi64(lanes, 1));
  lanes = _mm512_setzero_si512();
  return _mm512_reduce_add_epi64(_mm512_add_epi64(low, high));
}

/// The instruction wants signed bytes for one factor: 128 less, which is made good for in the end.
ROADFIX_VNNI inline __m512i less_128(__m512i bytes) { return _mm512_xor_si512(bytes, _mm512_set1_epi8(-128)); }

/// The sums at one place.
struct Place {
  const std::uint8_t* nadir = nullptr;
  __m512i m, mm, ml;
  __m512i hidden_l, hidden_ll;  ///< where the map has not observed: taken out of what the sums begin with
  IntegerSums sums;

  ROADFIX_VNNI Place() : m(_mm512_setzero_si512()), mm(m), ml(m), hidden_l(m), hidden_ll(m) {}
  ROADFIX_VNNI void start(const std::uint8_t* cell, const Footprint& footprint) {
    nadir = cell;
    m = mm = ml = hidden_l = hidden_ll = _mm512_setzero_si512();
    sums = {footprint.observed_cells(), 0, footprint.sum(), 0, footprint.sum_of_squares(), 0};
  }
  ROADFIX_VNNI void add(const Piece& piece, const std::uint8_t* values, __m512i l) {
    __m512i cells = _mm512_maskz_loadu_epi8(piece.observed, nadir + piece.offset);
    const __mmask64 hidden = _mm512_cmpeq_epi8_mask(cells, _mm512_set1_epi8(static_cast<char>(kUnobserved)));
    if (hidden != 0) [[unlikely]]
      cells = without(hidden, cells, values);
    const __m512i signed_cells = less_128(cells);
    m = _mm512_dpbusd_epi32(m, cells, _mm512_set1_epi8(1));
    mm = _mm512_dpbusd_epi32(mm, cells, signed_cells);
    ml = _mm512_dpbusd_epi32(ml, l, signed_cells);
  }
  ROADFIX_VNNI __m512i without(__mmask64 hidden, __m512i cells, const std::uint8_t* values) {
    const __m512i l = _mm512_maskz_loadu_epi8(hidden, values);
    hidden_l = _mm512_dpbusd_epi32(hidden_l, l, _mm512_set1_epi8(1));
    hidden_ll = _mm512_dpbusd_epi32(hidden_ll, l, less_128(l));
    sums.n -= _mm_popcnt_u64(hidden);
    return _mm512_maskz_mov_epi8(static_cast<__mmask64>(~hidden), cells);
  }
  ROADFIX_VNNI void flush(std::int64_t all) {
    sums.m += emptied(m);
    sums.mm += emptied(mm);
    sums.ml += emptied(ml);
    if (sums.n == all) return;
    const std::int64_t l = emptied(hidden_l);
    sums.l -= l;
    sums.ll -= emptied(hidden_ll) + 128 * l;
  }
};

/// Several places at once: the processor need not wait for a sum of one before it adds to the others.
template <std::size_t kPlaces>
ROADFIX_VNNI void add_up(const MapPlane& map, const Footprint& footprint, std::span<const Piece> pieces,
                         const PlaneCell* cells, IntegerSums* out) {
  std::array<Place, kPlaces> places;
  for (std::size_t k = 0; k < kPlaces; ++k) places[k].start(map.at(cells[k].col, cells[k].row), footprint);
  for (std::size_t first = 0; first < pieces.size(); first += kVectorsPerFlush) {
    const std::size_t last = std::min(pieces.size(), first + kVectorsPerFlush);
    for (std::size_t i = first; i < last; ++i) {
      const std::uint8_t* values = footprint.values() + i * kStep;
      const __m512i l = _mm512_load_si512(values);
      for (std::size_t k = 0; k < kPlaces; ++k) places[k].add(pieces[i], values, l);
    }
    for (Place& place : places) place.flush(footprint.observed_cells());
  }
  for (std::size_t k = 0; k < kPlaces; ++k) {
    IntegerSums& sums = places[k].sums;
    sums.mm += 128 * sums.m;
    sums.ml += 128 * footprint.sum();
    out[k] = sums;
  }
}

std::atomic<bool> allowed{true};

}  // namespace

bool has_byte_products() {
  static const bool kHas = __builtin_cpu_supports("avx512vnni") != 0 && __builtin_cpu_supports("avx512bw") != 0;
  return kHas && allowed;
}

void allow_byte_products_for_test(bool allow) { allowed = allow; }

void sums_by_byte_products(const MapPlane& map, const Footprint& footprint, std::span<const PlaneCell> places,
                           std::span<IntegerSums> sums) {
  assert(places.size() == sums.size());
  const std::vector<Piece> pieces = pieces_of(footprint, map.stride());
  std::size_t i = 0;
  for (; i + 4 <= places.size(); i += 4) add_up<4>(map, footprint, pieces, &places[i], &sums[i]);
  for (; i < places.size(); ++i) add_up<1>(map, footprint, pieces, &places[i], &sums[i]);
}

}  // namespace roadfix

#else

namespace roadfix {

bool has_byte_products() { return false; }

void allow_byte_products_for_test(bool /*allow*/) {}

void sums_by_byte_products(const MapPlane& /*map*/, const Footprint& /*footprint*/,
                           std::span<const PlaneCell> /*places*/, std::span<IntegerSums> /*sums*/) {
  assert(false);
}

}  // namespace roadfix

#endif
