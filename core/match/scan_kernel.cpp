#include "core/match/scan_kernel.hpp"

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/match/scan_kernel.cpp"
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

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace roadfix {

HWY_EXPORT(score);
HWY_EXPORT(summarize);

void score_row(const ScoreRow& row, int cols, float* out) { HWY_DYNAMIC_DISPATCH(score)(row, cols, out); }

RowTotals summarize_row(const float* above, const float* row, const float* below, int first, int last, float floor,
                        std::vector<int>& peaks) {
  return HWY_DYNAMIC_DISPATCH(summarize)(above, row, below, first, last, floor, peaks);
}

}  // namespace roadfix

#endif  // HWY_ONCE
