#include "core/proof/bound_sums.hpp"

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/proof/bound_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What lies between the ends of each run, from kCount places side by side: differences of what is summed before a cell
/// or block, kEach numbers for each.
template <typename Sum, int kCount, int kEach>
HWY_ATTR void add_runs(std::span<const RowRun> runs, const Sum* before, std::ptrdiff_t stride, Sum* out) {
  constexpr std::ptrdiff_t kStep = kEach;
  constexpr std::size_t kNumbers = kStep * kCount;
  constexpr hn::CappedTag<Sum, kNumbers> kLanes;
  const std::size_t step = hn::Lanes(kLanes);
  for (std::size_t start = 0; start < kNumbers; start += step) {
    auto sum = hn::Zero(kLanes);
    for (const RowRun& run : runs) {
      const Sum* row = before + run.row * stride + start;
      sum = hn::Add(sum, hn::Sub(hn::LoadU(kLanes, row + kStep * run.end), hn::LoadU(kLanes, row + kStep * run.first)));
    }
    hn::StoreU(sum, kLanes, out + start);
  }
}

void sum_runs(std::span<const RowRun> runs, const std::uint32_t* before, std::ptrdiff_t stride, std::uint32_t* out) {
  add_runs<std::uint32_t, BoundMap::kRun, 1>(runs, before, stride, out);
}

void sum_cells(std::span<const RowRun> runs, const CellSums* before, std::ptrdiff_t stride, CellSums* out) {
  static_assert(sizeof(CellSums) == 2 * sizeof(std::uint64_t));
  add_runs<std::uint64_t, kBlockCells, 2>(runs, &before->cells_and_values, 2 * stride, &out->cells_and_values);
}

#if HWY_TARGET == HWY_SCALAR

void sum_terms(const BoundTerms& terms, const std::uint8_t* const* planes, std::ptrdiff_t stride, std::uint32_t* out) {
  for (int i = 0; i < BoundMap::kRun; ++i) out[i] = 0;
  std::size_t t = 0;
  for (const BoundTerms::Group& group : terms.groups) {
    for (; t < group.end; ++t) {
      const BoundTerms::Term& term = terms.terms[t];
      const std::uint8_t* from = planes[term.plane] + term.row * stride + term.col;
      for (int i = 0; i < BoundMap::kRun; ++i) out[i] += group.weight * from[i];
    }
  }
}

#else

constexpr hn::CappedTag<std::uint8_t, BoundMap::kRun> kBytes;
constexpr hn::Repartition<std::uint16_t, decltype(kBytes)> kShorts;
constexpr hn::Repartition<std::uint32_t, decltype(kBytes)> kInts;
using Bytes = hn::Vec<decltype(kBytes)>;
using Shorts = hn::Vec<decltype(kShorts)>;
using Ints = hn::Vec<decltype(kInts)>;

// So many values of at most kFull fit into a byte.
constexpr std::size_t kBytesPerFlush = 4;
static_assert(kBytesPerFlush * BoundMap::kFull < 256);

HWY_ATTR void sum_terms(const BoundTerms& terms, const std::uint8_t* const* planes, std::ptrdiff_t stride,
                        std::uint32_t* out) {
  const std::size_t step = hn::Lanes(kBytes);
  const BoundTerms::Term* const all = terms.terms.data();
  for (std::size_t start = 0; start < BoundMap::kRun; start += step) {
    const auto load = [&](const BoundTerms::Term& term) HWY_ATTR {
      return hn::LoadU(kBytes, planes[term.plane] + term.row * stride + term.col + start);
    };
    Ints sum0 = hn::Zero(kInts);
    Ints sum1 = sum0;
    Ints sum2 = sum0;
    Ints sum3 = sum0;
    std::size_t t = 0;
    for (const BoundTerms::Group& group : terms.groups) {
      Shorts even = hn::Zero(kShorts);
      Shorts odd = even;
      // Neighbours part: even and odd bytes, later even and odd shorts.
      const auto flush = [&](Bytes bytes) HWY_ATTR {
        const Shorts shorts = hn::BitCast(kShorts, bytes);
        even = hn::Add(even, hn::And(shorts, hn::Set(kShorts, 0xFF)));
        odd = hn::Add(odd, hn::ShiftRight<8>(shorts));
      };
      for (; t + kBytesPerFlush <= group.end; t += kBytesPerFlush) {
        flush(hn::Add(hn::Add(load(all[t]), load(all[t + 1])), hn::Add(load(all[t + 2]), load(all[t + 3]))));
      }
      for (; t < group.end; ++t) flush(load(all[t]));
      const Ints weight = hn::Set(kInts, group.weight);
      const auto add_halves = [&](Shorts sums, Ints& first, Ints& second) HWY_ATTR {
        const Ints ints = hn::BitCast(kInts, sums);
        first = hn::Add(first, hn::Mul(hn::And(ints, hn::Set(kInts, 0xFFFF)), weight));
        second = hn::Add(second, hn::Mul(hn::ShiftRight<16>(ints), weight));
      };
      add_halves(even, sum0, sum2);
      add_halves(odd, sum1, sum3);
    }
    hn::StoreInterleaved4(sum0, sum1, sum2, sum3, kInts, out + start);
  }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace roadfix {

HWY_EXPORT(sum_terms);
HWY_EXPORT(sum_runs);
HWY_EXPORT(sum_cells);

void term_sums(const BoundMap& map, const BoundTerms& terms, int col, int row, RunSums& sums) {
  std::array<const std::uint8_t*, BoundMap::kPlanes> planes{};
  for (int i = 0; i < BoundMap::kPlanes; ++i) planes[static_cast<std::size_t>(i)] = map.plane(i, col, row);
  HWY_DYNAMIC_DISPATCH(sum_terms)(terms, planes.data(), map.stride(), sums.data());
}

void covered_sums(const BoundMap& map, std::span<const RowRun> runs, int col, int row, CoveredSums& sums) {
  const BoundMap::Sums before = map.sums_before(col, row);
  HWY_DYNAMIC_DISPATCH(sum_runs)(runs, before.cells, map.stride(), sums.cells.data());
  HWY_DYNAMIC_DISPATCH(sum_runs)(runs, before.value, map.stride(), sums.value.data());
  HWY_DYNAMIC_DISPATCH(sum_runs)(runs, before.square, map.stride(), sums.square.data());
}

void cell_sums(std::span<const RowRun> footprint, const CellSums* nadir, std::ptrdiff_t stride,
               std::array<CellSums, kBlockCells>& sums) {
  HWY_DYNAMIC_DISPATCH(sum_cells)(footprint, nadir, stride, sums.data());
}

}  // namespace roadfix

#endif  // HWY_ONCE
