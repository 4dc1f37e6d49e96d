#include "core/grid/bilinear_kernel.hpp"

// clang-format off: foreach_target compiles this file once per instruction set, and must come before highway.h
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/grid/bilinear_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#ifndef ROADFIX_QUAD_PLANE
#define ROADFIX_QUAD_PLANE
namespace roadfix {

struct QuadPlane {
  const std::int32_t* quads;
  int cols;  ///< of the source: a row of quads is one longer
  int rows;
};

}  // namespace roadfix
#endif

HWY_BEFORE_NAMESPACE();
namespace roadfix {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> kFloats;
constexpr hn::RebindToSigned<decltype(kFloats)> kInts;
constexpr hn::RebindToUnsigned<decltype(kFloats)> kUnsigned;
constexpr hn::Rebind<std::uint8_t, decltype(kFloats)> kBytes;
using Floats = hn::Vec<decltype(kFloats)>;
using Ints = hn::Vec<decltype(kInts)>;

// Cells are whole numbers up to 255 and shares multiples of 1/128, so that all sums and products of them are exact.
struct Quads {
  Floats above_left, above_right, below_left, below_right;
};

HWY_INLINE HWY_ATTR Quads parted(Ints quads) {
  const Ints byte = hn::Set(kInts, 255);
  const auto cell = [&](Ints bits) HWY_ATTR { return hn::ConvertTo(kFloats, hn::And(bits, byte)); };
  return {cell(quads), cell(hn::ShiftRight<8>(quads)), cell(hn::ShiftRight<16>(quads)),
          cell(hn::ShiftRight<24>(quads))};
}

/// Which quads have a byte that is 255: of the others none borrows when 1 is taken from each byte's complement.
HWY_INLINE HWY_ATTR auto any_unobserved(Ints quads) {
  const Ints borrowed = hn::Sub(hn::Not(quads), hn::Set(kInts, 0x01010101));
  const Ints high_bits = hn::Set(kInts, static_cast<std::int32_t>(0x80808080U));
  return hn::Ne(hn::And(hn::And(borrowed, quads), high_bits), hn::Zero(kInts));
}
static_assert(kUnobserved == 255);

/// bilinear() where all four cells were observed.
HWY_INLINE HWY_ATTR Floats observed_mean(const Quads& q, Floats fx, Floats fy) {
  const Floats upper = hn::MulAdd(fx, hn::Sub(q.above_right, q.above_left), q.above_left);
  const Floats lower = hn::MulAdd(fx, hn::Sub(q.below_right, q.below_left), q.below_left);
  return hn::Add(hn::MulAdd(fy, hn::Sub(lower, upper), upper), hn::Set(kFloats, 0.5F));
}

/// WeightedMean of the cells that were observed; `mean` where all were.
HWY_INLINE HWY_ATTR Floats partial_mean(const Quads& q, Floats fx, Floats fy, Floats mean) {
  const Floats one = hn::Set(kFloats, 1.0F);
  const Floats unobserved = hn::Set(kFloats, float{kUnobserved});
  Floats observed = hn::Zero(kFloats);
  Floats sum = observed;
  const auto add = [&](Floats cell, Floats weight) HWY_ATTR {
    const auto seen = hn::Ne(cell, unobserved);
    observed = hn::Add(observed, hn::IfThenElseZero(seen, weight));
    sum = hn::Add(sum, hn::IfThenElseZero(seen, hn::Mul(weight, cell)));
    return seen;
  };
  const Floats left = hn::Sub(one, fx);
  const Floats above = hn::Sub(one, fy);
  const auto seen0 = add(q.above_left, hn::Mul(left, above));
  const auto seen1 = add(q.above_right, hn::Mul(fx, above));
  const auto seen2 = add(q.below_left, hn::Mul(left, fy));
  const auto seen3 = add(q.below_right, hn::Mul(fx, fy));
  const auto whole = hn::And(hn::And(seen0, seen1), hn::And(seen2, seen3));
  const auto enough = hn::Ge(observed, hn::Set(kFloats, 0.5F));
  const Floats part = hn::Add(hn::Div(sum, hn::IfThenElse(enough, observed, one)), hn::Set(kFloats, 0.5F));
  return hn::IfThenElse(whole, mean, hn::IfThenElse(enough, part, unobserved));
}

/// `count` cells in a row, from the run's start on.
void sample_run(const QuadPlane& source, const SnappedPlacement::Run& run, int count, Cell* out) {
  constexpr int kCellBits = SnappedPlacement::kCellBits;
  constexpr int kDropped = kCellBits - SnappedPlacement::kShareBits;
  const int step = static_cast<int>(hn::Lanes(kFloats));
  const Ints lanes = hn::Iota(kInts, 0);
  const Ints share_mask = hn::Set(kInts, (1 << SnappedPlacement::kShareBits) - 1);
  const Floats share_unit = hn::Set(kFloats, 1.0F / (1 << SnappedPlacement::kShareBits));
  const auto cols = hn::Set(kUnsigned, static_cast<std::uint32_t>(source.cols + 1));
  const auto rows = hn::Set(kUnsigned, static_cast<std::uint32_t>(source.rows + 1));
  const Ints stride = hn::Set(kInts, source.cols + 1);
  Ints x = hn::Add(hn::Set(kInts, run.col), hn::Mul(lanes, hn::Set(kInts, run.col_step)));
  Ints y = hn::Add(hn::Set(kInts, run.row), hn::Mul(lanes, hn::Set(kInts, run.row_step)));
  const Ints x_step = hn::Set(kInts, step * run.col_step);
  const Ints y_step = hn::Set(kInts, step * run.row_step);
  for (int i = 0; i < count; i += step, x = hn::Add(x, x_step), y = hn::Add(y, y_step)) {
    const Ints col = hn::ShiftRight<kCellBits>(x);
    const Ints row = hn::ShiftRight<kCellBits>(y);
    const auto within = hn::And(hn::Lt(hn::BitCast(kUnsigned, col), cols), hn::Lt(hn::BitCast(kUnsigned, row), rows));
    const auto inside = hn::RebindMask(kInts, within);
    const auto share = [&](Ints at) HWY_ATTR {
      return hn::Mul(hn::ConvertTo(kFloats, hn::And(hn::ShiftRight<kDropped>(at), share_mask)), share_unit);
    };
    const Ints index = hn::IfThenElseZero(inside, hn::Add(hn::Mul(row, stride), col));
    const Ints quads = hn::GatherIndex(kInts, source.quads, index);
    const Quads q = parted(quads);
    const Floats fx = share(x);
    const Floats fy = share(y);
    Floats mean = observed_mean(q, fx, fy);
    if (!hn::AllFalse(kInts, any_unobserved(quads))) mean = partial_mean(q, fx, fy, mean);
    const Ints cells = hn::IfThenElse(inside, hn::ConvertTo(kInts, mean), hn::Set(kInts, kUnobserved));
    if (i + step <= count) {
      hn::StoreU(hn::DemoteTo(kBytes, cells), kBytes, out + i);
    } else {
      Cell rest[16] = {};
      hn::StoreU(hn::DemoteTo(kBytes, cells), kBytes, rest);
      for (int k = 0; k < count - i; ++k) out[i + k] = rest[k];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace roadfix
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/units/index_range.hpp"

namespace roadfix {

HWY_EXPORT(sample_run);

namespace {

/// Narrowed to about where -1 < start + (col + 0.5) * step < size + 1.
IndexRange narrowed(IndexRange range, double start, double step, double size) {
  constexpr double kFlat = 1e-6;
  if (std::abs(step) < kFlat) return start > -2.0 && start < size + 2.0 ? range : IndexRange{};
  const double a = (-1.0 - start) / step;
  const double b = (size + 1.0 - start) / step;
  const auto bounded = [&](double col) {
    return static_cast<int>(std::clamp(col, static_cast<double>(range.first), static_cast<double>(range.end)));
  };
  return {bounded(std::min(a, b) - 1.0), bounded(std::max(a, b) + 2.0)};
}

}  // namespace

BilinearSource::BilinearSource(const CellArray& cells)
    : cols_(cells.cols()),
      rows_(cells.rows()),
      quads_(static_cast<std::size_t>(cols_ + 1) * static_cast<std::size_t>(rows_ + 1)) {
  CellArray padded(cols_ + 2, rows_ + 2);
  paste(cells, padded, 1, 1);
  for (int row = 0; row <= rows_; ++row) {
    const Cell* above = padded.row(row).data();
    const Cell* below = padded.row(row + 1).data();
    std::int32_t* out = quads_.data() + static_cast<std::ptrdiff_t>(row) * (cols_ + 1);
    for (int col = 0; col <= cols_; ++col) {
      const auto quad = static_cast<std::uint32_t>(above[col]) | static_cast<std::uint32_t>(above[col + 1]) << 8U |
                        static_cast<std::uint32_t>(below[col]) << 16U |
                        static_cast<std::uint32_t>(below[col + 1]) << 24U;
      out[col] = static_cast<std::int32_t>(quad);
    }
  }
}

CellArray BilinearSource::sampled(const Placement& placement, int cols, int rows) const {
  assert(std::max(cols_, rows_) < SnappedPlacement::kMaxCells);
  CellArray result(cols, rows);
  const QuadPlane plane{quads_.data(), cols_, rows_};
  const SnappedPlacement snapped(placement);
  for (int row = 0; row < rows; ++row) {
    const GridGeometry::CellPosition start = placement.source_of(0.0, row + 0.5);
    IndexRange range{0, cols};
    range = narrowed(range, start.col, placement.right.col, cols_);
    range = narrowed(range, start.row, placement.right.row, rows_);
    while (range.count() > 0) {
      const int count = std::min(range.count(), SnappedPlacement::cells_left(range.first));
      HWY_DYNAMIC_DISPATCH(sample_run)
      (plane, snapped.run_at(range.first, row), count, result.row(row).data() + range.first);
      range.first += count;
    }
  }
  return result;
}

}  // namespace roadfix

#endif  // HWY_ONCE
