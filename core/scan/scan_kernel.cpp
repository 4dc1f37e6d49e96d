#include "core/scan/scan_kernel.hpp"

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/scan/scan_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, kRowOverrun> kFloats;
using Floats = hn::Vec<decltype(kFloats)>;

void score(const ScoreRow& row, int cols, float* out) {
  const Floats share = hn::Set(kFloats, row.share);
  const Floats scale = hn::Set(kFloats, row.scale);
  for (int col = 0; col < cols; col += static_cast<int>(hn::Lanes(kFloats))) {
    const auto load = [col](const float* from) HWY_ATTR { return hn::LoadU(kFloats, from + col); };
    const auto between = [&](const std::array<const float*, 2>& rows) HWY_ATTR {
      const Floats first = load(rows[0]);
      return hn::MulAdd(share, hn::Sub(load(rows[1]), first), first);
    };
    const Floats excess = hn::Sub(hn::Mul(scale, load(row.sums)), between(row.correction));
    hn::StoreU(hn::Mul(hn::Mul(load(row.eligible), excess), between(row.gain)), kFloats, out + col);
  }
}

RowTotals summarize(const float* above, const float* row, const float* below, int first, int last, float floor,
                    std::vector<int>& peaks) {
  const int step = static_cast<int>(hn::Lanes(kFloats));
  const Floats zero = hn::Zero(kFloats);
  Floats squares = zero;
  RowTotals totals;
  for (int col = first; col < last; col += step) {
    const auto load = [col](const float* from, int shift) HWY_ATTR { return hn::LoadU(kFloats, from + col + shift); };
    const auto within = hn::FirstN(kFloats, static_cast<std::size_t>(last - col < step ? last - col : step));
    const Floats score = hn::IfThenElseZero(within, load(row, 0));
    squares = hn::MulAdd(score, score, squares);
    totals.poses += static_cast<std::int64_t>(hn::CountTrue(kFloats, hn::Ne(score, zero)));
    const auto high = hn::And(within, hn::Gt(score, hn::Set(kFloats, floor)));
    if (hn::AllFalse(kFloats, high)) continue;
    const auto widest = [&](const float* from)
                            HWY_ATTR { return hn::Max(hn::Max(load(from, -1), load(from, 1)), load(from, 0)); };
    const Floats around = hn::Max(hn::Max(widest(above), widest(below)), hn::Max(load(row, -1), load(row, 1)));
    const auto is_peak = hn::And(high, hn::Ge(score, around));
    if (hn::AllFalse(kFloats, is_peak)) continue;
    HWY_ALIGN float flags[kRowOverrun];
    hn::Store(hn::IfThenElseZero(is_peak, hn::Set(kFloats, 1.0F)), kFloats, flags);
    for (int lane = 0; lane < step; ++lane) {
      if (flags[lane] > 0.0F) peaks.push_back(col + lane);
    }
  }
  totals.squares = static_cast<double>(hn::GetLane(hn::SumOfLanes(kFloats, squares)));
  return totals;
}

struct Means {
  Floats correction, gain;
};

HWY_INLINE HWY_ATTR Means means_at(Floats n, Floats l, Floats ll, Floats m, Floats mm, const MeansLimits& limits) {
  const Floats one = hn::Set(kFloats, 1.0F);
  const auto enough = hn::Ge(n, hn::Set(kFloats, limits.min_cells));
  const Floats per_cell = hn::Div(one, hn::IfThenElse(enough, n, one));
  const Floats map_spread = hn::NegMulAdd(hn::Mul(m, m), per_cell, mm);
  const Floats feature_spread = hn::NegMulAdd(hn::Mul(l, l), per_cell, ll);
  const Floats min = hn::Mul(n, hn::Set(kFloats, limits.min_variance));
  const auto scored = hn::And(enough, hn::And(hn::Ge(map_spread, min), hn::Ge(feature_spread, min)));
  const Floats spreads = hn::IfThenElse(scored, hn::Mul(map_spread, feature_spread), one);
  const Floats share = hn::Mul(n, hn::Set(kFloats, 1.0F / limits.full_cells));
  return {hn::IfThenElseZero(scored, hn::Mul(hn::Mul(m, l), per_cell)),
          hn::IfThenElseZero(scored, hn::Sqrt(hn::Div(hn::Max(share, hn::Zero(kFloats)), spreads)))};
}

void block_means(const BlockRow& sums, const MeansLimits& limits, int count, float* correction, float* gain) {
  const int step = static_cast<int>(hn::Lanes(kFloats));
  int i = 0;
  for (; i + step <= count; i += step) {
    const auto load = [i](const float* from) HWY_ATTR { return hn::LoadU(kFloats, from + i); };
    const Means means = means_at(load(sums.n), load(sums.l), load(sums.ll), load(sums.m), load(sums.mm), limits);
    hn::StoreU(means.correction, kFloats, correction + i);
    hn::StoreU(means.gain, kFloats, gain + i);
  }
  for (; i < count; ++i) {
    const auto load = [i](const float* from) HWY_ATTR { return hn::Set(kFloats, from[i]); };
    const Means means = means_at(load(sums.n), load(sums.l), load(sums.ll), load(sums.m), load(sums.mm), limits);
    correction[i] = hn::GetLane(means.correction);
    gain[i] = hn::GetLane(means.gain);
  }
}

void interpolate(const float* blocks, const std::int32_t* first, const std::int32_t* second, const float* share,
                 int count, float* out) {
  constexpr hn::RebindToSigned<decltype(kFloats)> kInts;
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(kFloats))) {
    const Floats a = hn::GatherIndex(kFloats, blocks, hn::LoadU(kInts, first + i));
    const Floats b = hn::GatherIndex(kFloats, blocks, hn::LoadU(kInts, second + i));
    hn::StoreU(hn::MulAdd(hn::LoadU(kFloats, share + i), hn::Sub(b, a), a), kFloats, out + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace roadfix {

HWY_EXPORT(score);
HWY_EXPORT(summarize);
HWY_EXPORT(block_means);
HWY_EXPORT(interpolate);

void score_row(const ScoreRow& row, int cols, float* out) { HWY_DYNAMIC_DISPATCH(score)(row, cols, out); }

RowTotals summarize_row(const float* above, const float* row, const float* below, int first, int last, float floor,
                        std::vector<int>& peaks) {
  return HWY_DYNAMIC_DISPATCH(summarize)(above, row, below, first, last, floor, peaks);
}

void means_of_blocks(const BlockRow& sums, const MeansLimits& limits, int count, float* correction, float* gain) {
  HWY_DYNAMIC_DISPATCH(block_means)(sums, limits, count, correction, gain);
}

void interpolate_blocks(const float* blocks, const std::int32_t* first, const std::int32_t* second, const float* share,
                        int count, float* out) {
  HWY_DYNAMIC_DISPATCH(interpolate)(blocks, first, second, share, count, out);
}

}  // namespace roadfix

#endif  // HWY_ONCE
